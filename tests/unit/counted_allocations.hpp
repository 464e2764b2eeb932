// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye::test {

/// Counts what is allocated in a program that links counted_allocations.cpp, which puts itself
/// between everybody, libraries included, and the C library's allocator. False under a sanitizer,
/// which has an allocator of its own that is not to be disturbed.
bool counts_allocations();

/// So far, in all threads.
std::int64_t allocations();

}  // namespace handeye::test
