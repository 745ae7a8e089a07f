#!/bin/bash
# The program and the library are hardened: how they were compiled, and what came of it in the files.
# usage: hardening.sh BUILD_FOLDER PROGRAM_OR_LIBRARY...
set -euo pipefail
build=$1
shift
fail() {
  echo "$*"
  exit 1
}

# Of all that goes into them: what is compiled from src/ and drivers/, but the examples.
commands=$(grep '"command":' "$build/compile_commands.json" | grep -E ' -c [^ ]*/(src|drivers)/[^ ]*\.(cpp|cxx)' | grep -v /examples/)
[ -n "$commands" ] || fail "no command that compiles src/ or drivers/"
for flag in -fstack-protector-strong -fstack-clash-protection -D_FORTIFY_SOURCE=2; do
  bare=$(grep -v -e " $flag" <<< "$commands" | head -1 || true)
  [ -z "$bare" ] || fail "compiled without $flag: ${bare: -200}"
done

for file in "$@"; do
  dynamic=$(readelf --dynamic --wide "$file") headers=$(readelf --file-header --program-headers --wide "$file")
  symbols=$(readelf --dyn-syms --wide "$file")
  grep -q 'Type: *DYN' <<< "$headers" || fail "$file: is not position-independent"
  grep -q GNU_RELRO <<< "$headers" || fail "$file: its tables stay writable (RELRO)"
  grep -Eq 'BIND_NOW|Flags:.*NOW' <<< "$dynamic" || fail "$file: functions are bound late, so its tables stay writable (-z now)"
  grep -Eq 'GNU_STACK.* RW ' <<< "$headers" || fail "$file: its stack can be executed"
  ! grep -Eq 'LOAD.* RWE ' <<< "$headers" || fail "$file: has memory to be written and executed"
  ! grep -q '(TEXTREL)' <<< "$dynamic" || fail "$file: its code is changed when it is loaded"
  grep -q __stack_chk_fail <<< "$symbols" || fail "$file: no stack protector"
  grep -Eq '__[a-z]+_chk@' <<< "$symbols" || fail "$file: no checked copies (_FORTIFY_SOURCE)"
done
