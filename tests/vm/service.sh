#!/bin/bash
# The service under a real systemd: makes a Debian file system from nothing, installs the build into it, boots it in a
# virtual machine with vivid and v4l2loopback as cameras, and checks there what systemd and the service make of each
# other: a line a check. What was made is kept in CACHE; the guest's changes to it are not.
#
# usage: service.sh BUILD CACHE
# BUILD is a build folder with the targets edgeslam, feed_loopback and stall_thread. Needs root and the packages that it
# names where they are missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source-path=SCRIPTDIR
source "$here/machine.sh"
# shellcheck source-path=SCRIPTDIR
source "$here/service_root.sh"

build=$(realpath "$1")
mkdir -p "$2"
cache=$(realpath "$2")
abi=$(kernel_abi)
require qemu-system-x86 busybox-static kmod cpio mmdebstrap e2fsprogs binutils "linux-headers-$abi"
get_kernel "$abi"
build_loopback "$abi"
make_root "$build/edgeslam" "$cache/debian.img"

"$build/edgeslam" simulate panels_textured --width 160 --height 120 --frames 150 --fps 10 --speed 0.3 \
  --output "$cache/service_sequence" --force > /dev/null 2>&1
make_map "$build" "$cache/service_sequence"
install_project "$build" "$cache/installation"
install_checks "$build" "$cache/installation"

first=$cache/service_initramfs
begin_initramfs "$first"
add_modules "$first" early "$cache/kernel-$abi" "$abi" virtio_pci virtio_blk ext4 9pnet_virtio 9p
add_modules "$first" cameras "$cache/kernel-$abi" "$abi" vivid "$cache/v4l2loopback-$abi.ko"
cp "$here/service_init.sh" "$first/init"
rm -rf "$cache/results"
mkdir "$cache/results"
mapfile -t folders < <(share installation "$cache/installation" readonly=on; share results "$cache/results")
start_machine 1500 "$cache/kernel-$abi" "$abi" "$first" "systemd.show_status=no systemd.log_target=journal" -m 1536 \
  -drive "file=$cache/debian.img,format=raw,if=virtio,snapshot=on" "${folders[@]}" | sed -u 's|\r$||' | tee "$cache/service_output.txt" | grep --line-buffered -E '^(ok|FAILED|--|service checks| {8})' || true
grep -q '^service checks: all passed' "$cache/service_output.txt"
