#!/bin/bash
# Makes the sysroot, where there is none yet, and cross-builds for 64-bit ARM.   usage: build.sh SOURCES FOLDER TARGET...
# As root, with a Debian mirror in reach; 77: not here.
set -euo pipefail
sources=$1
folder=$2
shift 2

for tool in aarch64-linux-gnu-g++ qemu-aarch64-static mmdebstrap; do
  command -v "$tool" > /dev/null || { echo "skipped: no $tool"; exit 77; }
done
((EUID == 0)) || { echo "skipped: not root"; exit 77; }

mkdir -p "$folder"
if [[ ! -e $folder/sysroot.made ]]; then
  rm -rf "$folder/sysroot"
  if ! "$sources/toolchains/make-sysroot" arm64 "$folder/sysroot" > "$folder/sysroot.log" 2>&1; then
    tail "$folder/sysroot.log"
    if grep -qE 'Failed to fetch|Could not (resolve|connect)|Temporary failure resolving|Unable to connect' "$folder/sysroot.log"; then
      echo "skipped: no Debian mirror in reach"
      exit 77
    fi
    exit 1
  fi
  touch "$folder/sysroot.made"
fi
echo "sysroot: ${SECONDS} s"
cmake -S "$sources" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DEDGESLAM_SYSROOT="$folder/sysroot" \
  -DEDGESLAM_DEBUG_SYMBOLS=ON -DCMAKE_UNITY_BUILD=ON \
  --toolchain "$sources/toolchains/aarch64-linux-gnu.cmake" > "$folder/configure.log" 2>&1 || { tail -20 "$folder/configure.log"; exit 1; }
echo "configured: ${SECONDS} s"
cmake --build "$folder/build" --parallel 1 --target "$@" > "$folder/build.log" 2>&1 || { tail -40 "$folder/build.log"; exit 1; }
echo "built: ${SECONDS} s"
