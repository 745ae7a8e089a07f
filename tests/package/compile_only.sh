#!/bin/bash
# Stands before a compiler (CMAKE_CXX_COMPILER_LAUNCHER and CMAKE_CXX_LINKER_LAUNCHER): the compiler checks the file and makes no code;
# objects and programs are empty files. Much cheaper than a build; of the warnings, those are missing which need the optimiser.
# usage: compile_only.sh COMPILER ARGUMENT...
set -euo pipefail
output='' compiles=''
for ((i = 1; i < $#; ++i)); do
  case ${!i} in
    -o) next=$((i + 1)); output=${!next} ;;
    -c) compiles=yes ;;
  esac
done
[[ -z $compiles ]] || "$@" -fsyntax-only
[[ -z $output ]] || : > "$output"
