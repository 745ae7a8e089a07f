#!/bin/sh
# Checks that every source file is as clang-format would write it. usage: formatting.sh CLANG_FORMAT REPOSITORY
set -eu
cd "$2"
find . -path ./build -prune -o -path './.*' -prune -o -type f \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
  xargs -0 "$1" --dry-run --Werror
