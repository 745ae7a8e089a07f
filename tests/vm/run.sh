#!/bin/bash
# Boots a small virtual machine with Debian's kernel and runs the camera tests in it, against real kernel drivers: vivid and
# v4l2loopback; with --vimc also vimc through Debian 12's libcamera (0.0.3); with --virtual then, in a second machine with
# Debian 13's kernel and packages, libcamera 0.4.0 and its virtual pipeline. Everything is made from nothing in CACHE and
# kept there.
#
# usage: run.sh VM_TESTS CACHE [--vimc] [--virtual] [GTEST_OPTION...]
# Needs root (the guest reads the host's files) and the packages that it names where they are missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

program=$(realpath "$1")
mkdir -p "$2"
cache=$(realpath "$2")
shift 2
vimc=0 virtual=0
while [[ ${1-} == --vimc || ${1-} == --virtual ]]; do
  if [[ $1 == --vimc ]]; then vimc=1; else virtual=1; fi
  shift
done

# The kernel's name changes with its ABI number.
abi=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: linux-image-//p' | head -1)
[[ -n $abi ]] || { echo "run.sh: apt knows no linux-image-amd64; apt-get update?" >&2; exit 2; }

packages=(qemu-system-x86 busybox-static kmod cpio "linux-headers-$abi")
((virtual)) && packages+=(debootstrap xz-utils)
missing=()
for package in "${packages[@]}"; do
  [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null) == installed ]] || missing+=("$package")
done
if ((${#missing[@]})); then
  echo "run.sh: missing packages: apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 2
fi

# get PACKAGE FOLDER: its files, without installing it.
get() {
  [[ -e $cache/$2.done ]] && return
  rm -rf "${cache:?}/$2"
  (cd "$cache" && apt-get download -q "$1" && dpkg-deb -x "$1"_*.deb "$2" && rm "$1"_*.deb)
  touch "$cache/$2.done"
}

get "linux-image-$abi" "kernel-$abi"
kernel=$cache/kernel-$abi
[[ -e $kernel/lib/modules/$abi/modules.dep.bin ]] || depmod -b "$kernel" "$abi"

# build NAME FOLDER FILE [MAKE_OPTION...]: a module that Debian's kernel lacks.
build() {
  local name=$1 folder=$2 file=$3
  shift 3
  [[ -e $cache/$name-$abi.ko ]] && return
  make -s -C "/usr/src/linux-headers-$abi" M="$folder" "$@" modules > "$cache/$name.log" 2>&1 ||
    { tail "$cache/$name.log" >&2; exit 2; }
  cp "$folder/$file" "$cache/$name-$abi.ko"
}

get v4l2loopback-dkms loopback
build v4l2loopback "$(echo "$cache"/loopback/usr/src/v4l2loopback-*)" v4l2loopback.ko
own=("$cache/v4l2loopback-$abi.ko")
if ((vimc)); then
  source=linux-source-${abi%%-*}
  source=${source%.*}
  get "$source" vimc
  [[ -e $cache/vimc/driver ]] ||
    { tar -C "$cache/vimc" -xf "$cache"/vimc/usr/src/linux-source-*.tar.xz --wildcards '*/drivers/media/test-drivers/vimc' &&
      mv "$cache"/vimc/linux-source-*/drivers/media/test-drivers/vimc "$cache/vimc/driver"; }
  build vimc "$cache/vimc/driver" vimc.ko CONFIG_VIDEO_VIMC=m
  own+=("$cache/vimc-$abi.ko")
fi

# boot KERNEL_FOLDER ABI ROOT PROGRAM MODULE...: runs PROGRAM, a path in ROOT, which becomes the guest's root. True where
# it ended well.
boot() {
  local kernel=$1 abi=$2 root=$3 program=$4 first=$cache/initramfs log=$cache/output.txt module file name
  shift 4
  rm -rf "$first"
  mkdir -p "$first"/{bin,modules,host,proc,sys,dev}
  cp /bin/busybox "$first/bin/"
  ln -s busybox "$first/bin/sh"
  : > "$first/modules/early"
  : > "$first/modules/cameras"
  add() { # LIST MODULE: with those that it needs, in their order
    modprobe -d "$kernel" -S "$abi" --show-depends "$2" | while read -r _ file _; do
      [[ $file == /* ]] || continue
      name=$(basename "$file" .xz)
      grep -qx "$name" "$first"/modules/{early,cameras} && continue
      if [[ $file == *.xz ]]; then xz -dc "$file" > "$first/modules/$name"; else cp "$file" "$first/modules/$name"; fi
      echo "$name" >> "$first/modules/$1"
    done
  }
  for module in virtio_pci 9pnet_virtio 9p; do add early "$module"; done
  for module in "$@"; do
    if [[ $module == */* ]]; then
      name=$(basename "$module" "-$abi.ko").ko
      cp "$module" "$first/modules/$name"
      echo "$name" >> "$first/modules/cameras"
    else
      add cameras "$module"
    fi
  done
  cp "$here/init.sh" "$first/init"
  {
    printf 'program=%q\n' "$program"
    printf 'options=%q\n' "${options[*]}"
    printf 'libcamera=%q\n' "$libcamera"
  } > "$first/settings"
  (cd "$first" && find . | cpio --quiet -o -H newc | gzip -1) > "$cache/initramfs.gz"

  # Never KVM: where it is nested it may hang without a word. The tests keep up with TCG.
  timeout 1000 qemu-system-x86_64 -accel tcg,thread=multi -cpu max -smp 2 -m 1024 -display none -no-reboot \
    -kernel "$kernel/boot/vmlinuz-$abi" -initrd "$cache/initramfs.gz" -append "console=ttyS0 panic=-1 quiet" \
    -fsdev "local,id=host,path=$root,security_model=none,readonly=on,multidevs=remap" \
    -device virtio-9p-pci,fsdev=host,mount_tag=host -serial stdio -monitor none < /dev/null | tee "$log"
  grep -q '^vm_tests: exit code 0' "$log"
}

options=("$@")
libcamera=$vimc
boot "$kernel" "$abi" / "$program" vivid "${own[@]}"
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
  src/dataset/text_file.cpp -o libcamera_tests -lgtest -lgtest_main -lcamera -lcamera-base -lturbojpeg -lopencv_core'
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
