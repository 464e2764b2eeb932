# SPDX-License-Identifier: BSD-3-Clause
# bash completion for handeye, handeyed and handeye-sim.
# Installed to share/bash-completion/completions under each of the three names.

# Files and folders; with a pattern only files that match it, and all folders.
_handeye_files() {
  local current=$1 pattern=${2:-*}
  compopt -o filenames
  local IFS=$'\n'
  COMPREPLY=($(compgen -d -- "$current") $(compgen -f -X "!$pattern" -- "$current"))
}

# Subcommand or option, whatever follows: the words that are left to choose from.
_handeye_words() {
  COMPREPLY=($(compgen -W "$1" -- "$2"))
}

# The options that a program's own --help lists: never out of step with the program.
_handeye_options_of() {
  "$@" --help 2>/dev/null | grep -oE -- '(^|[ ,])--[a-z][a-z-]*' | tr -d ' ,' | sort -u
}

# The methods that the program itself lists.
_handeye_methods() {
  "${COMP_WORDS[0]}" solve --list-methods 2>/dev/null | sed -n '2,$s/ .*//p' | sort -u
}

# Completes the value of an option; false when the option takes none that could be completed.
_handeye_value() {
  local option=$1 current=$2
  case $option in
    --color) _handeye_words 'auto always never' "$current" ;;
    --mask) _handeye_files "$current" '*.png' ;;
    --eye) _handeye_words 'sfm pattern' "$current" ;;
    --output) _handeye_files "$current" '*.json' ;;
    --save | --truth | --start) _handeye_files "$current" '*.json' ;;
    --intrinsics) _handeye_words 'fixed refine estimate' "$current" ;;
    --config) _handeye_files "$current" '*.toml' ;;
    --camera) _handeye_files "$current" ;;
    --board) _handeye_words 'chessboard:9x6:4 charuco:8x6:6:4.5:DICT_4X4_50' "$current" ;;
    --motion) _handeye_words 'free translation rotation single-axis pivot static' "$current" ;;
    --scene) _handeye_words 'tissue plane bare' "$current" ;;
    --disturb) _handeye_words 'flicker highlights round blur missing instrument interlaced frozen dark' "$current" ;;
    --distortion) _handeye_words 'none inside' "$current" ;;
    --controller-fault) _handeye_words 'refuse slow garbage error silent busy' "$current" ;;
    --scale) _handeye_words 'known unknown' "$current" ;;
    --method) _handeye_words "all $(_handeye_methods)" "$current" ;;
    --lcm-url) _handeye_words 'udpm://239.255.76.67:7667?ttl=0' "$current" ;;
    --amplitude | --lens | --body | --sigma | --max-duration | --timeout | --duration | --count | --prefix | --port | --controller-port | --controller-address | --max-* | --*-noise) COMPREPLY=() ;;
    *) return 1 ;;
  esac
}

_handeye() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local commands='calibrate status watch cancel pose record replay solve onestep intrinsics compare tracker'
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    _handeye_words "$commands --help --version" "$current"
    return
  fi
  _handeye_value "$previous" "$current" && return
  local command=${COMP_WORDS[1]}
  if [[ $current == -* ]]; then
    _handeye_words "$(_handeye_options_of "${COMP_WORDS[0]}" "$command")" "$current"
    return
  fi
  case $command in
    replay) _handeye_files "$current" '*.lcm' ;;
    solve) _handeye_files "$current" '*.csv' ;;
    record | intrinsics) _handeye_files "$current" ;;
    onestep | compare) _handeye_files "$current" '*.json' ;;
    tracker) [ "$previous" = --controller ] || _handeye_words 'start stop status' "$current" ;;
  esac
}

_handeyed() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  if [ "$previous" = --config ]; then
    _handeye_files "$current" '*.toml'
    return
  fi
  _handeye_value "$previous" "$current" && return
  _handeye_words "$(_handeye_options_of "${COMP_WORDS[0]}")" "$current"
}

_handeye_sim() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  _handeye_value "$previous" "$current" && return
  if [[ $current == -* ]]; then
    local command=${COMP_WORDS[1]}
    if [[ $COMP_CWORD -gt 1 && $command != -* ]]; then
      _handeye_words "$(_handeye_options_of "${COMP_WORDS[0]}" "$command")" "$current"
    else
      _handeye_words "$(_handeye_options_of "${COMP_WORDS[0]}")" "$current"
    fi
    return
  fi
  if [ "$COMP_CWORD" -eq 1 ]; then
    _handeye_words 'run record --help --version' "$current"
  else
    _handeye_files "$current"
  fi
}

complete -F _handeye handeye
complete -F _handeyed handeyed
complete -F _handeye_sim handeye-sim
