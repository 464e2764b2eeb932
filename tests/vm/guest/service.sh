# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=sh
# shellcheck disable=SC2317 # functions are called by name
# What the guests' scripts ask about the installed service. Sourced, after checks.sh.
configuration=/etc/handeyed/handeyed.toml
since=0

property() { systemctl show handeyed.service --property="$1" --value; }
has_property() { [ "$(property "$1")" = "$2" ]; }
is_serving() { handeye status >status.log 2>&1; }
journal_says() { journalctl --unit=handeyed.service --output=cat | grep -q "$1"; }
# mark: from here on journal_has looks. journal_has FIELD=VALUE...: an entry of the service with these fields.
# By time: --after-cursor= passes over the first entry with these fields.
mark() { since=$(date +%s.%6N); }
journal_has() {
  journalctl --sync
  journalctl --unit=handeyed.service --output=cat --since="@$since" "$@" | grep -q .
}

install_package() { dpkg --install debs/handeyed_*.deb; }

small_pictures() { sed -i 's/^width = .*/width = 640/; s/^height = .*/height = 360/' "$configuration"; }

# The kernel's test driver as a camera, which udev then names.
plug_camera() { modprobe vivid n_devs=1 node_types=0x1 vid_cap_nr=0 num_inputs=1 input_types=0x0; }
# As by pulling the plug, while the service streams.
unplug_camera() {
  echo vivid.0 >/sys/bus/platform/drivers/vivid/unbind
  within 20 rmmod vivid
}

# Seconds since the guest was started.
now() { cut -d' ' -f1 /proc/uptime; }
# took NAME SINCE: for the log, and for whoever compares.
took() { awk -v name="$1" -v since="$2" -v now="$(now)" 'BEGIN { printf "# %s: %.1f s\n", name, now - since }'; }

show_service() {
  systemctl show handeyed.service --property=StatusText,NRestarts,ExecMainStatus
  journalctl --unit=handeyed.service --output=short-monotonic --no-pager
}
