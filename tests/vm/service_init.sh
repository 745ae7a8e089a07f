#!/bin/sh
# The guest's init (service.sh): puts the installation into Debian's file system, loads the cameras' drivers, and hands over
# to systemd.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
while read -r module; do insmod "/modules/$module"; done < /modules/early
mount -t ext4 /dev/vda /host
mkdir /installation
mount -t 9p -o trans=virtio,version=9p2000.L,ro,msize=262144 installation /installation
cp -a /installation/. /host/
umount /installation

mkdir -p /host/opt/checks/modules
cp /modules/*.ko /host/opt/checks/modules/
while read -r module; do
  case $module in
    vivid.ko) insmod /modules/vivid.ko n_devs=1 node_types=0x1 num_inputs=1 input_types=0 ;;
    v4l2loopback.ko) ;; # plugged in later
    *) insmod "/modules/$module" ;;
  esac
done < /modules/cameras
umount /dev
umount /proc
umount /sys
exec switch_root /host /sbin/init
