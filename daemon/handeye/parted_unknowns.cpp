// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/parted_unknowns.hpp"

namespace handeye {

UnknownsVector of_part(const PartedVector& all, std::size_t part) {
  UnknownsVector own;
  for (int i = 0; i < kUnknowns; ++i) own[i] = all[index_of(i, part)];
  return own;
}

void add_part(const UnknownsVector& own, std::size_t part, PartedVector& all) {
  for (int i = 0; i < kUnknowns; ++i) all[index_of(i, part)] += own[i];
}

void add_part(const UnknownsMatrix& own, std::size_t part, PartedMatrix& all) {
  for (int j = 0; j < kUnknowns; ++j) {
    for (int i = 0; i < kUnknowns; ++i) all(index_of(i, part), index_of(j, part)) += own(i, j);
  }
}

PartedUnknowns PartedUnknowns::moved_by(const PartedVector& step) const {
  PartedUnknowns moved = *this;
  for (std::size_t part = 0; part < parts(); ++part) {
    moved.of_parts_[part] = of_parts_[part].moved_by(of_part(step, part));
  }
  return moved;
}

}  // namespace handeye
