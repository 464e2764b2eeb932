// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/dtrack/line_context.hpp"
#include "drivers/dtrack/scanner.hpp"

namespace handeye::dtrack {

/// What became of one target of a line.
enum class Target : std::uint8_t {
  kTaken,
  kLeftOut,      ///< rightly: it is not tracked, and its list holds tracked ones only
  kBadRotation,  ///< the body is refused, the line goes on
  kFailed,       ///< the line is refused; the scanner knows why
};

/// Target::kFailed if the scanner has failed, for readers that end with a read.
constexpr Target taken_if(bool good) {
  return good ? Target::kTaken : Target::kFailed;
}

/// Appends the targets of one line to a list of the frame. Unless commit() is reached the list is
/// afterwards as it was before.
template <typename Element>
class ListUpdate {
 public:
  ListUpdate(std::vector<Element>& list, LineContext& context)
      : list_(list), context_(context), first_(list.size()) {}
  ListUpdate(const ListUpdate&) = delete;
  ListUpdate(ListUpdate&&) = delete;
  ListUpdate& operator=(const ListUpdate&) = delete;
  ListUpdate& operator=(ListUpdate&&) = delete;
  ~ListUpdate() { erase(first_, committed_ ? first_ : list_.size()); }

  Element& append() { return list_.emplace_back(); }

  /// Keeps the element appended last or drops it, and forgets an earlier one with its id.
  void settle_last(Target target) {
    const std::size_t last = list_.size() - 1;
    const std::int32_t id = list_[last].id;
    if (target == Target::kBadRotation) ++bad_rotations_;
    if (target != Target::kTaken) erase(last, last + 1);
    if (id > highest_id_) {  // ids ascend as a rule: then there is nothing to look for
      highest_id_ = id;
      return;
    }
    for (std::size_t i = first_; i < last; ++i) {
      if (list_[i].id != id) continue;
      erase(i, i + 1);
      ++duplicates_;
      return;
    }
  }

  /// Publishes: what an earlier line of the same type had left goes.
  void commit() {
    erase(0, first_);
    committed_ = true;
    first_ = 0;
    context_.counters[WarningKind::kDuplicateId] += duplicates_;
    context_.counters[ErrorKind::kBadRotation] += bad_rotations_;
    context_.counters.rejected_bodies += bad_rotations_;
  }

 private:
  void erase(std::size_t first, std::size_t last) {
    for (std::size_t i = last; i > first; --i) release(list_[i - 1], context_.memory);
    const auto begin = list_.begin();
    list_.erase(begin + static_cast<std::ptrdiff_t>(first),
                begin + static_cast<std::ptrdiff_t>(last));
  }

  std::vector<Element>& list_;
  LineContext& context_;
  std::size_t first_;
  bool committed_{false};
  std::int32_t highest_id_{-1};
  std::uint64_t duplicates_{0};
  std::uint64_t bad_rotations_{0};
};

/// Reads `count` targets, to the end of the line, and publishes them. `read_target(line, element)`
/// fills a fresh element and returns a Target.
template <typename Element, typename ReadTarget>
bool read_targets(Scanner& line, std::int32_t count, std::vector<Element>& list,
                  LineContext& context, const ReadTarget& read_target) {
  ListUpdate<Element> update(list, context);
  for (std::int32_t i = 0; i < count; ++i) {
    const Target target = read_target(line, update.append());
    if (target == Target::kFailed) return false;
    update.settle_last(target);
  }
  const bool surplus = line.at_block();
  if (!surplus && !line.finish()) return false;
  if (surplus) ++context.counters[WarningKind::kSurplusTargets];
  update.commit();
  return true;
}

/// `ndef n`: devices defined, and how many of them follow.
inline bool read_defined_and_count(Scanner& line, std::int32_t& count) {
  std::int32_t defined = 0;
  if (!line.read_count(defined) || !line.read_count(count)) return false;
  return count <= defined || line.fail(ErrorKind::kBadCount);
}

}  // namespace handeye::dtrack
