#!/bin/bash
# Completion in bash knows every subcommand and option of the program. usage: completion_test.sh PROGRAM COMPLETION
set -euo pipefail
program=$1
bash_completion=/usr/share/bash-completion/bash_completion
[[ -e $bash_completion ]] || { echo "skipped: no bash-completion"; exit 77; }
set +u
source "$bash_completion"
source "$2"

# What is offered after these words, the last of them being typed, sorted.
offered() {
  COMP_WORDS=("$program" "$@")
  COMP_CWORD=$#
  COMP_LINE="${COMP_WORDS[*]}"
  COMP_POINT=${#COMP_LINE}
  COMPREPLY=()
  _edgeslam
  printf '%s\n' "${COMPREPLY[@]}" | sort
}
expect() {
  [[ "$1" == "$2" ]] || { echo "expected: $2"; echo "offered: $1"; exit 1; }
}

subcommands=$("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p' | sort)
[[ $(wc -l <<< "$subcommands") -ge 8 ]] || { echo "subcommands of --help not understood: $subcommands"; exit 1; }
expect "$(offered '' | grep -v '^--')" "$subcommands"
expect "$(offered 're')" "$(printf 'record\nreplay\nreport')"
for subcommand in $subcommands; do
  options=$("$program" "$subcommand" --help | grep -oE '(^|,|  )--[a-z-]+' | grep -oE '\-\-[a-z-]+' | sort -u)
  [[ -n $options ]] || { echo "$subcommand: no options in --help"; exit 1; }
  expect "$(offered "$subcommand" --)" "$options"
done
expect "$(offered evaluate --alignment '')" "$(printf 'none\nrigid\nsimilarity')"
