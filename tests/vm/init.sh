#!/bin/sh
# The guest's init (run.sh): loads the drivers and runs the tests on the host's files, which it sees read-only.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
. /settings
while read -r module; do insmod "/modules/$module"; done < /modules/early
mount -t 9p -o trans=virtio,version=9p2000.L,ro,msize=262144,cache=loose host /host
mount -t devtmpfs devtmpfs /host/dev
mount -t proc proc /host/proc
mount -t sysfs sysfs /host/sys
mount -t tmpfs tmpfs /host/mnt
mount -t tmpfs tmpfs /host/run

# Two cameras: a webcam, and one of the multi-planar kind.
while read -r module; do
  case $module in
    vivid.ko) insmod /modules/vivid.ko n_devs=2 node_types=0x1,0x1 num_inputs=1,1 input_types=0,0 multiplanar=1,2 ;;
    v4l2loopback.ko) insmod /modules/v4l2loopback.ko video_nr=42 exclusive_caps=0 card_label=Loopback ;;
    *) insmod "/modules/$module" ;;
  esac
done < /modules/cameras

# What udevd would have written, without which libcamera finds no device.
mkdir -p /host/run/udev/data
for device in /sys/class/video4linux/* /sys/bus/media/devices/*; do
  [ -e "$device/dev" ] && echo "I:1000000" > "/host/run/udev/data/c$(cat "$device/dev")"
done
[ "$libcamera" = 1 ] && export EDGESLAM_LIBCAMERA=1
[ -e /host/dev/video42 ] && export EDGESLAM_LOOPBACK=/dev/video42
export TMPDIR=/mnt HOME=/mnt PATH=/usr/bin:/bin:/usr/sbin:/sbin
# shellcheck disable=SC2086
chroot /host "$program" $options
echo "vm_tests: exit code $?"
reboot -f
