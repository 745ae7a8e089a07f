#!/bin/bash
# Compiles in another Debian, by another compiler, or builds and runs the unit tests there. As root, with a Debian mirror in reach.
#
#     tests/package/other_systems.sh SUITE COMPILER FOLDER [TARGET...]
#
# SUITE: bookworm, trixie, ...   COMPILER: a Debian package's name, g++-14 or clang-19   TARGET: all, edgeslam, flow_tests, ...
# Without a target, every file is checked by the compiler, and no code is made, which takes much less time.
# FOLDER has the system, the build and the compiler's cache; a later call goes on from there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
sources=$(cd "$here/../.." && pwd)
. "$here/clean_debian.sh"

(($# >= 3)) || { sed -n '2,9s/^# \?//p' "${BASH_SOURCE[0]}"; exit 2; }
suite=$1
compiler=$2
folder=$(realpath -m "$3")
targets=("${@:4}")
root=$folder/$suite
command=${compiler/clang-/clang++-}
log=$folder/$suite-$compiler.log

# The sources lie in the system read-only; what is built, beside them.
mount_all() {
  mkdir -p "$root/src" "$root/build" "$root/ccache" "$folder/ccache"
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
  mountpoint -q "$root/src" || { mount --bind "$sources" "$root/src" && mount -o remount,bind,ro "$root/src"; }
  mountpoint -q "$root/ccache" || mount --bind "$folder/ccache" "$root/ccache"
}
unmount_all() {
  for place in src ccache proc; do umount "$root/$place" 2> /dev/null || true; done
}

make_system() {
  mkdir -p "$folder"
  if [[ ! -e $root.made ]]; then
    rm -rf --one-file-system "$root"
    make_clean_debian "$suite" "$root"
    touch "$root.made"
  fi
  mount_all
  # shellcheck disable=SC2046
  inside "$root" apt-get install -qq -y --no-install-recommends $(cat "$sources/.ci/packages") ccache "$compiler" > "$folder/$suite.log" 2>&1 ||
    { tail "$folder/$suite.log"; exit 1; }
}

in_system() { inside "$root" env CCACHE_DIR=/ccache CCACHE_BASEDIR=/src CCACHE_NOHASHDIR=1 "$@"; }

# configure FOLDER OPTION...
configure() {
  in_system cmake -S /src -B "$1" -G Ninja -DCMAKE_CXX_COMPILER="$command" "${@:2}" > "$log" 2>&1 || { tail -20 "$log"; exit 1; }
}

# build FOLDER TARGET...: goes on after a file that fails, and shows the messages.
build() {
  in_system ninja -C "$1" -j 1 -k 0 "${@:2}" >> "$log" 2>&1 || { grep -E 'FAILED:|error:' "$log" | cut -c1-300 | head -40; exit 1; }
}

check_every_file() {
  local at=/build/check-$compiler launcher=/src/tests/package/compile_only.sh objects
  configure "$at" -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" -DCMAKE_CXX_LINKER_LAUNCHER="$launcher" -DCMAKE_BUILD_TYPE=Debug
  mapfile -t objects < <(in_system ninja -C "$at" -t targets all | sed -n 's/: CXX_COMPILER__.*//p')
  build "$at" "${objects[@]}"
  echo "ok: ${#objects[@]} files without a warning"
}

build_and_test() {
  local at=/build/$compiler failed=0 program tests result
  configure "$at" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_BUILD_TYPE=Release
  build "$at" "$@"
  for tests in "$root$at"/*_tests; do
    program=$(basename "$tests")
    result=$folder/$suite-$compiler-$program.log
    in_system "$at/$program" --gtest_brief=1 > "$result" 2>&1 || { failed=1; grep -E '^\[  FAILED' "$result" | sort -u | cut -c1-200; }
    echo "$program: $(grep -E '^\[==========\]' "$result" | tail -1 | cut -c14-)"
  done
  return $failed
}

((EUID == 0)) || { echo "other_systems.sh: must be run as root" >&2; exit 2; }
trap unmount_all EXIT
make_system
echo "$suite: $(inside "$root" "$command" --version | head -1)"
if ((${#targets[@]})); then build_and_test "${targets[@]}"; else check_every_file; fi
