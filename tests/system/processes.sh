# SPDX-License-Identifier: BSD-3-Clause
# Shell functions that start simulator and daemon on ports of their own. Sourced by tests/system/demo.

# A UDP port that no socket of this host is bound to right now.
free_udp_port() {
  local port
  while :; do
    port=$((20000 + (RANDOM << 15 | RANDOM) % 40000))
    grep -qi ":$(printf '%04X' "$port") " /proc/net/udp || { echo "$port"; return; }
  done
}

# write_config FILE PORT LCM_URL CAMERA_JSON: the daemon's configuration for a simulated set-up.
write_config() {
  cat >"$1" <<TOML
[lcm]
url = "$3"

[tracker]
port = $2

[camera]
driver = "lcm"
intrinsics = "$4"
TOML
}

# wait_until SECONDS COMMAND...: false when the command did not succeed in time.
wait_until() {
  local deadline=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ "$SECONDS" -lt "$deadline" ] || return 1
    sleep 0.1
  done
}
