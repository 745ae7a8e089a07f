#!/bin/bash
# Boots a small virtual machine with Debian's kernel and runs the camera tests in it, against real kernel drivers: vivid,
# v4l2loopback and, with --vimc, vimc through libcamera. Everything is made from nothing in CACHE and kept there.
#
# usage: run.sh VM_TESTS CACHE [--vimc] [GTEST_OPTION...]
# Needs root (the guest reads the host's files) and the packages that it names where they are missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

program=$(realpath "$1")
mkdir -p "$2"
cache=$(realpath "$2")
shift 2
vimc=0
if [[ ${1-} == --vimc ]]; then vimc=1; shift; fi

# The kernel's name changes with its ABI number.
abi=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: linux-image-//p' | head -1)
[[ -n $abi ]] || { echo "run.sh: apt knows no linux-image-amd64; apt-get update?" >&2; exit 2; }

packages=(qemu-system-x86 busybox-static kmod cpio "linux-headers-$abi")
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
own=(v4l2loopback)
if ((vimc)); then
  source=linux-source-${abi%%-*}
  source=${source%.*}
  get "$source" vimc
  [[ -e $cache/vimc/driver ]] ||
    { tar -C "$cache/vimc" -xf "$cache"/vimc/usr/src/linux-source-*.tar.xz --wildcards '*/drivers/media/test-drivers/vimc' &&
      mv "$cache"/vimc/linux-source-*/drivers/media/test-drivers/vimc "$cache/vimc/driver"; }
  build vimc "$cache/vimc/driver" vimc.ko CONFIG_VIDEO_VIMC=m
  own+=(vimc)
fi

# The guest's first files: busybox, the modules in the order of their needs, and init.
root=$cache/initramfs
rm -rf "$root"
mkdir -p "$root"/{bin,modules,host,proc,sys,dev}
cp /bin/busybox "$root/bin/"
ln -s busybox "$root/bin/sh"
: > "$root/modules/early"
: > "$root/modules/cameras"
add() { # LIST MODULE
  modprobe -d "$kernel" -S "$abi" --show-depends "$2" | while read -r _ file _; do
    local name
    name=$(basename "$file")
    grep -qx "$name" "$root"/modules/{early,cameras} && continue
    cp "$file" "$root/modules/$name"
    echo "$name" >> "$root/modules/$1"
  done
}
add early virtio_pci
add early 9pnet_virtio
add early 9p
add cameras vivid
for name in "${own[@]}"; do
  cp "$cache/$name-$abi.ko" "$root/modules/$name.ko"
  [[ $name != vimc ]] || echo "$name.ko" >> "$root/modules/cameras"
done
cp "$here/init.sh" "$root/init"
{
  printf 'program=%q\n' "$program"
  printf 'options=%q\n' "$*"
  printf 'vimc=%q\n' "$vimc"
} > "$root/settings"
(cd "$root" && find . | cpio --quiet -o -H newc | gzip -1) > "$cache/initramfs.gz"

# Never KVM: where it is nested it may hang without a word. The tests keep up with TCG.
log=$cache/output.txt
timeout 1000 qemu-system-x86_64 -accel tcg,thread=multi -cpu max -smp 2 -m 1024 -display none -no-reboot \
  -kernel "$kernel/boot/vmlinuz-$abi" -initrd "$cache/initramfs.gz" -append "console=ttyS0 panic=-1 quiet" \
  -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap -device virtio-9p-pci,fsdev=host,mount_tag=host \
  -serial stdio -monitor none < /dev/null | tee "$log"
grep -q '^vm_tests: exit code 0' "$log"
