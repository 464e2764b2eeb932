// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace handeye {

/// The kernel's driver "vivid": video devices without hardware, with everything that can go wrong
/// behind controls. In a guest only: it loads and unloads the kernel's module.
///
/// Loaded, there are two cameras: kVivid with three inputs, and kVividMultiplanar, a webcam with
/// the multiplanar interface.
inline constexpr const char* kVivid = "/dev/video0";
inline constexpr const char* kVividMultiplanar = "/dev/video1";

/// The inputs of kVivid.
enum class VividInput { kWebcam = 0, kHdmi = 1, kTelevision = 2 };

void load_vivid();
void unload_vivid();

/// The controls keep their values until this; all devices must be closed.
inline void renew_vivid() {
  unload_vivid();
  load_vivid();
}

/// Sets a control by its name ("Wrap Timestamp"). The device is open only meanwhile.
void set_control(const std::string& name, std::int32_t value, const char* device = kVivid);

/// Sets a menu by the name of the control and of the item ("DV Timings", "1280x720p60").
void set_menu(const std::string& name, const std::string& item, const char* device = kVivid);

void select_input(VividInput input);

/// The name of the driver behind a device, as the kernel has it.
std::string driver_name(const char* device);

/// What the device is set to, asked beside the driver under test.
struct VividSetting {
  std::uint32_t fourcc{0};
  int width{0};   ///< px
  int height{0};  ///< px
  double rate_hz{0};
};
VividSetting setting_of(const char* device);

}  // namespace handeye
