// SPDX-License-Identifier: BSD-3-Clause
// Nothing is allocated for a datagram once parser and frame have seen one like it. The counting
// operators new and delete below serve this whole test program.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "drivers/dtrack/formatter.hpp"
#include "tests/unit/dtrack/dtrack_text.hpp"

namespace {
std::atomic<std::size_t> allocations{0};

void* counted_allocation(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size != 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  return counted_allocation(size);
}
void* operator new[](std::size_t size) {
  return counted_allocation(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace handeye::dtrack {
namespace {

/// Of parsing `text` once more, after it has been parsed once.
std::size_t allocations_of_second_parse(const std::string& text) {
  Parser parser;
  Frame frame;
  const std::size_t before_first = allocations;
  parser.parse(text, frame);
  EXPECT_GT(allocations - before_first, 0U) << "the counter does not count";
  const std::size_t before_second = allocations;
  parser.parse(text, frame);
  return allocations - before_second;
}

TEST(DTrackAllocation, SecondParseOfAFullFrame) {
  EXPECT_EQ(allocations_of_second_parse(sample("full_frame.txt")), 0U);
  EXPECT_EQ(allocations_of_second_parse(sample("dtrack1_frame.txt")), 0U);
}

TEST(DTrackAllocation, RefusedAndRepeatedLinesAllocateNothingEither) {
  const std::string full = sample("full_frame.txt");
  EXPECT_EQ(allocations_of_second_parse(full + sample("6df2.txt") + sample("gl.txt") +
                                        sample("6dj.txt") + sample("st.txt")),
            0U);
  const std::string flystick_cut_short = sample("6df2.txt").substr(0, 200);
  EXPECT_EQ(allocations_of_second_parse(full + flystick_cut_short + "\r\nst 1 [0"), 0U);
}

TEST(DTrackAllocation, NestedListsKeepTheirMemoryThroughFramesWithoutThem) {
  Parser parser;
  Frame frame;
  const std::string full = sample("full_frame.txt");
  parser.parse(full, frame);
  parser.parse("fr 1\r\n", frame);
  const std::size_t before = allocations;
  parser.parse(full, frame);
  EXPECT_EQ(allocations - before, 0U);
}

TEST(DTrackAllocation, FormattingIntoTheSameString) {
  const Parsed parsed(sample("full_frame.txt"));
  std::string text;
  format_datagram(parsed.frame, text);
  const std::size_t before = allocations;
  format_datagram(parsed.frame, text);
  EXPECT_EQ(allocations - before, 0U);
}

}  // namespace
}  // namespace handeye::dtrack
