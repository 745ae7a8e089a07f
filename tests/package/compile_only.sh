#!/bin/bash
# Stands before a compiler (CMAKE_CXX_COMPILER_LAUNCHER): the compiler checks the file and makes no code; the object is an empty file.
# Much cheaper than a build; of the warnings, those are missing which need the optimiser.
# usage: compile_only.sh COMPILER ARGUMENT...
set -euo pipefail
object=
for ((i = 1; i < $#; ++i)); do
  if [[ ${!i} == -o ]]; then next=$((i + 1)); object=${!next}; fi
done
"$@" -fsyntax-only
[[ -z $object ]] || : > "$object"
