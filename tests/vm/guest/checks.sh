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

finish() {
  echo "1..$checks"
  [ "$failures" = 0 ]
  exit
}
