#!/bin/bash
# Boots a small virtual machine with Debian's kernel and runs the camera tests in it, against real kernel drivers: vivid
# and v4l2loopback, with recordings fed through it into the daemon; with --vimc also vimc through Debian 12's libcamera
# (0.0.3); with --virtual then, in a second machine with Debian 13's kernel and packages, libcamera 0.4.0 and its virtual
# pipeline. Everything is made from nothing in CACHE and kept there.
#
# usage: run.sh VM_TESTS CACHE [--vimc] [--virtual] [GTEST_OPTION...]
# VM_TESTS is that program in its build folder, beside edgeslam. Needs root (the guest reads the host's files) and the
# packages that it names where they are missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source-path=SCRIPTDIR
source "$here/machine.sh"

program=$(realpath "$1")
mkdir -p "$2"
cache=$(realpath "$2")
shift 2
vimc=0 virtual=0
while [[ ${1-} == --vimc || ${1-} == --virtual ]]; do
  if [[ $1 == --vimc ]]; then vimc=1; else virtual=1; fi
  shift
done

abi=$(kernel_abi)
packages=(qemu-system-x86 busybox-static kmod cpio "linux-headers-$abi")
((virtual)) && packages+=(debootstrap xz-utils)
require "${packages[@]}"
get_kernel "$abi"
build_loopback "$abi"
own=("$cache/v4l2loopback-$abi.ko")
if ((vimc)); then
  source=linux-source-${abi%%-*}
  source=${source%.*}
  get "$source" vimc
  [[ -e $cache/vimc/driver ]] ||
    { tar -C "$cache/vimc" -xf "$cache"/vimc/usr/src/linux-source-*.tar.xz --wildcards '*/drivers/media/test-drivers/vimc' &&
      mv "$cache"/vimc/linux-source-*/drivers/media/test-drivers/vimc "$cache/vimc/driver"; }
  build "$abi" vimc "$cache/vimc/driver" vimc.ko CONFIG_VIDEO_VIMC=m
  own+=("$cache/vimc-$abi.ko")
fi

# boot KERNEL_FOLDER ABI ROOT PROGRAM MODULE...: runs PROGRAM, a path in ROOT, which becomes the guest's root. True where
# it ended well.
boot() {
  local kernel=$1 abi=$2 root=$3 program=$4 first=$cache/initramfs log=$cache/output.txt host
  shift 4
  begin_initramfs "$first"
  add_modules "$first" early "$kernel" "$abi" virtio_pci 9pnet_virtio 9p
  add_modules "$first" cameras "$kernel" "$abi" "$@"
  cp "$here/init.sh" "$first/init"
  {
    printf 'program=%q\n' "$program"
    printf 'options=%q\n' "${options[*]}"
    printf 'libcamera=%q\n' "$libcamera"
    printf 'export EDGESLAM_SEQUENCE=%q\n' "$sequence"
    printf 'export EDGESLAM_SHARED_SEQUENCE=%q\n' "$shared_sequence"
    printf 'export EDGESLAM_LOOPBACK_MODULE=%q\n' "$cache/v4l2loopback-$abi.ko"
  } > "$first/settings"
  mapfile -t host < <(share host "$root" readonly=on)
  start_machine 2000 "$kernel" "$abi" "$first" "" -m 1536 "${host[@]}" | tee "$log"
  grep -q '^vm_tests: exit code 0' "$log"
}

# Recordings that are fed through v4l2loopback: one of our own and, where it lies beside the source folder, a shared one.
sequence=$cache/sequence
shared_sequence=$(realpath -m "$here/../../../shared/data/tex_near")
[[ -e $shared_sequence ]] || shared_sequence=""
"$(dirname "$program")/edgeslam" simulate panels_textured --width 160 --height 120 --frames 150 --fps 10 --speed 0.3 \
  --output "$sequence" --force > /dev/null 2>&1

options=("$@")
libcamera=$vimc
boot "$cache/kernel-$abi" "$abi" / "$program" vivid "${own[@]}"
((virtual)) || exit 0

# Debian 13: its packages in a folder, its kernel, and the libcamera driver built there.
trixie=$cache/trixie
mirror=$(grep -rhoE 'https?://[^ ]+/debian/?( |$)' /etc/apt/sources.list* 2> /dev/null | head -1 | tr -d ' ' || true)
if [[ ! -e $trixie.done ]]; then
  rm -rf "$trixie"
  debootstrap --variant=minbase \
    --include=g++,libcamera-dev,libcamera-ipa,libopencv-core-dev,libturbojpeg0-dev,libboost-dev,libgtest-dev \
    trixie "$trixie" "${mirror:-http://deb.debian.org/debian}" > "$cache/trixie.log" ||
    { tail "$cache/trixie.log" >&2; exit 2; }
  chroot "$trixie" sh -c 'cd /tmp && apt-get download $(apt-cache depends linux-image-amd64 | sed -n "s/.*Depends: //p" | head -1)'
  dpkg-deb -x "$trixie"/tmp/linux-image-*.deb "$cache/kernel-trixie"
  [[ -e $cache/kernel-trixie/lib ]] || ln -s usr/lib "$cache/kernel-trixie/lib"
  touch "$trixie.done"
fi
abi=$(basename "$cache"/kernel-trixie/lib/modules/*)
[[ -e $cache/kernel-trixie/lib/modules/$abi/modules.dep.bin ]] || depmod -b "$cache/kernel-trixie" "$abi"
rm -rf "$trixie/project"
mkdir -p "$trixie/project/tests/vm"
cp -r "$here"/../../{src,drivers,include} "$trixie/project/"
cp "$here/libcamera_test.cpp" "$trixie/project/tests/vm/"
chroot "$trixie" sh -c 'cd /project && g++ -std=c++17 -O1 -Wall -Wextra -Werror -I. -Isrc -Iinclude -isystem /usr/include/opencv4 \
  -isystem /usr/include/libcamera tests/vm/libcamera_test.cpp drivers/frame_capture/*.cpp drivers/libcamera/*.cpp \
  src/files/text_file.cpp -o libcamera_tests -lgtest -lgtest_main -lcamera -lcamera-base -lturbojpeg -lopencv_core'
mkdir -p "$trixie/usr/share/libcamera/pipeline/virtual"
cat > "$trixie/usr/share/libcamera/pipeline/virtual/virtual.yaml" <<'YAML'
"Virtual0":
  supported_formats:
    - {width: 640, height: 480, frame_rates: [30, 60]}
  test_pattern: "lines"
  location: "CameraLocationFront"
  model: "Virtual test camera"
YAML
libcamera=1
boot "$cache/kernel-trixie" "$abi" "$trixie" /project/libcamera_tests
