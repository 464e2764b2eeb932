# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=sh
# Checks for the scripts that run in a guest. Sourced; ends with `finish`.
checks=0
failures=0

# check TEXT COMMAND...: passes when the command succeeds.
check() {
  text=$1
  shift
  checks=$((checks + 1))
  if "$@" >check.log 2>&1; then
    echo "ok $checks - $text"
  else
    failures=$((failures + 1))
    echo "not ok $checks - $text"
    sed 's/^/  # /' check.log
  fi
}

# within SECONDS COMMAND...: tries again until the command succeeds or the time is over.
within() {
  end=$(($(cut -d. -f1 /proc/uptime) + $1))
  shift
  until "$@"; do
    [ "$(cut -d. -f1 /proc/uptime)" -lt "$end" ] || return 1
    sleep 0.5
  done
}

# after_reboot: true when the test runs again after `reboot_and_go_on`; the checks are counted on.
after_reboot() {
  [ -e before_reboot ] || return 1
  checks=$(cat before_reboot)
}

# With a failure there is nothing to go on for.
reboot_and_go_on() {
  [ "$failures" = 0 ] || finish
  echo "$checks" >before_reboot
  echo "# reboot"
  exit 100
}

finish() {
  echo "1..$checks"
  [ "$failures" = 0 ]
  exit
}
