// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace handeye::simulator {

/// What makes a real endoscope's pictures harder than ideal ones. By default nothing does.
struct Disturbances {
  double flicker{0};        ///< largest change of the grey levels, e.g. 0.35, within a second
  bool highlights{false};   ///< the surface is wet: saturated spots that move with the light
  bool round_view{false};   ///< a disc of the image is all there is
  double defocus_px{0};     ///< standard deviation of a Gaussian
  double exposure_s{0};     ///< how long the shutter stays open: motion blur
  double missing_share{0};  ///< of the frames, lost one or two at a time
  bool instrument{false};   ///< a rod moves over up to a third of the picture
  bool interlaced{false};   ///< odd lines are half a frame's time later than even ones
  double frozen_s{0};       ///< so long out of every ten seconds the picture stands still
  double dark_s{0};         ///< so long out of every ten seconds there is no light
};

/// Switches a disturbance on by name, as strong as the endoscope's own everyday. False: no such
/// name.
bool add_disturbance(std::string_view name, Disturbances& disturbances);

/// In the order that help lists them.
std::span<const std::string_view> disturbance_names();

/// The names of what is switched on, separated by commas; "none".
std::string describe(const Disturbances& disturbances);

}  // namespace handeye::simulator
