// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// The same samples, stamped by what the clock model knew up to 10 s later: with half of its window
/// before and half behind. As they come it knows but the data before, in the first second next to
/// none: 16 data of 1 ms of jitter stamp a fifth of a millisecond late. Stamps that would change by
/// more than 2.5 ms stay: then the way has become another, or the clock was stepped. Only the
/// samples that are there; no room for more. Pure; a microsecond a sample.
PoseBuffer with_hindsight(const PoseBuffer& samples);

}  // namespace handeye
