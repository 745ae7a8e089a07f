#!/bin/bash
# Builds in another Debian, by another compiler, and runs the unit tests of the stages there. As root, with a Debian mirror in reach.
#
#     tests/package/other_systems.sh SUITE COMPILER FOLDER [TARGET...]
#
# SUITE: bookworm, trixie, ...   COMPILER: a Debian package's name, g++-14 or clang-19   TARGET: edgeslam, flow_tests, ...; default: all
# FOLDER has the system, the build and the compiler's cache; a later call goes on from there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
sources=$(cd "$here/../.." && pwd)
. "$here/clean_debian.sh"

(($# >= 3)) || { sed -n '2,8s/^# \?//p' "${BASH_SOURCE[0]}"; exit 2; }
suite=$1
compiler=$2
folder=$(realpath -m "$3")
targets=("${@:4}")
root=$folder/$suite
build=/build/$compiler

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

build_and_test() {
  local at_once=(inside "$root" nice -n 15 env CCACHE_DIR=/ccache CCACHE_BASEDIR=/src CCACHE_NOHASHDIR=1)
  "${at_once[@]}" cmake -S /src -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="${compiler/clang-/clang++-}" \
    -DCMAKE_CXX_COMPILER_LAUNCHER=ccache > "$folder/$suite-$compiler.log" 2>&1 || { tail -20 "$folder/$suite-$compiler.log"; exit 1; }
  "${at_once[@]}" cmake --build "$build" --parallel 1 ${targets:+--target "${targets[@]}"} -- -k 0 >> "$folder/$suite-$compiler.log" 2>&1 ||
    { grep -E 'FAILED|error:' "$folder/$suite-$compiler.log" | cut -c1-300 | head -40; exit 1; }
  local failed=0 program tests
  for tests in "$root$build"/*_tests; do
    program=$(basename "$tests")
    inside "$root" nice -n 15 "$build/$program" --gtest_brief=1 > "$folder/$suite-$compiler-$program.log" 2>&1 ||
      { failed=1; grep -E '^\[  FAILED' "$folder/$suite-$compiler-$program.log" | sort -u | cut -c1-200; }
    echo "$program: $(grep -E '^\[==========\]' "$folder/$suite-$compiler-$program.log" | tail -1 | cut -c14-)"
  done
  return $failed
}

((EUID == 0)) || { echo "other_systems.sh: must be run as root" >&2; exit 2; }
trap unmount_all EXIT
make_system
echo "$suite: $(inside "$root" "${compiler/clang-/clang++-}" --version | head -1)"
build_and_test
