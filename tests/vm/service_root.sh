# Sourced by service.sh: Debian with systemd from nothing, and in it the project as it is installed.

# packages_for PROGRAM: those whose libraries it is linked with, as a package would depend on them.
packages_for() {
  local library paths=()
  for library in $(objdump -p "$1" | awk '/NEEDED/ {print $2}'); do
    library=$(realpath "$(ldd "$1" | awk -v name="$library" '$1 == name {print $3}')")
    paths+=("*${library#/usr}")
  done
  dpkg -S "${paths[@]}" | cut -d: -f1 | sort -u | paste -sd,
}

# make_root PROGRAM IMAGE: an ext4 image with what PROGRAM needs, systemd and udev. Made anew where the packages change.
make_root() {
  local folder=$cache/debian packages
  packages=systemd-sysv,udev,kmod,iproute2,procps,v4l-utils,$(packages_for "$1")
  [[ -e $2 && $(cat "$2.packages" 2> /dev/null) == "$packages" ]] && return
  echo "making Debian's file system"
  rm -rf --one-file-system "$folder" "$2" "$2.packages"
  mkdir "$folder"
  mmdebstrap --quiet --dpkgopt=force-unsafe-io --variant=minbase --include="$packages" bookworm - http://deb.debian.org/debian 2> "$cache/debian.log" |
    tar -C "$folder" --exclude='./dev/*' -x || { tail "$cache/debian.log" >&2; exit 2; }
  echo 00000000000000000000000000000005 > "$folder/etc/machine-id"  # without one the first start asks questions
  echo robot > "$folder/etc/hostname"
  : > "$folder/etc/fstab"
  systemctl --root="$folder" mask --quiet getty.target serial-getty@ttyS0.service apt-daily.timer apt-daily-upgrade.timer \
    dpkg-db-backup.timer e2scrub_all.timer e2scrub_reap.service fstrim.timer systemd-firstboot.service \
    systemd-timesyncd.service
  rm -rf "$folder"/usr/share/{doc,man,locale}/*
  truncate -s 3G "$2"
  mkfs.ext4 -q -d "$folder" "$2"
  echo "$packages" > "$2.packages"
}

# make_map BUILD SEQUENCE: that the service goes on with; an emulated processor takes long to begin one.
make_map() {
  cp "$here/service_robot.yaml" "$2/robot.yaml"
  "$1/edgeslam" replay "$2" --config "$2/robot.yaml" --output "$cache/service_replay" --drawings 0 --map-out "$2/robot.map" \
    > "$cache/service_replay.log" 2>&1 || { tail "$cache/service_replay.log" >&2; exit 2; }
}

# install_project BUILD FOLDER: the release as `cmake --install` puts it on a robot, a robot's configuration, and enabled.
install_project() {
  rm -rf "$2"
  DESTDIR=$2 cmake --install "$1" --prefix /usr > "$cache/install.log" || { tail "$cache/install.log" >&2; exit 2; }
  cp "$here/service_robot.yaml" "$2/etc/edgeslam/robot.yaml"
  mkdir -p "$2/etc/systemd/system/multi-user.target.wants"
  ln -s /usr/lib/systemd/system/edgeslam.service "$2/etc/systemd/system/multi-user.target.wants/"
}

# install_checks BUILD FOLDER: what the checks need besides, in /opt/checks, and the unit that runs them.
install_checks() {
  local checks=$2/opt/checks
  mkdir -p "$checks"
  cp "$1/feed_loopback" "$1/stall_thread" "$here"/service_checks*.sh "$checks/"
  cp -r "$cache/service_sequence" "$checks/sequence"
  cp "$cache/service_sequence/camera.yaml" "$2/etc/edgeslam/camera.yaml"
  mkdir -p "$2/var/lib/edgeslam"
  cp "$cache/service_sequence/robot.map" "$2/var/lib/edgeslam/"
  cat > "$2/etc/systemd/system/checks.service" <<'UNIT'
[Unit]
Description=Checks of the service
After=edgeslam.service

[Service]
Type=oneshot
ExecStart=/bin/bash /opt/checks/service_checks.sh
StandardOutput=tty
StandardError=tty
TTYPath=/dev/ttyS0
TimeoutStartSec=infinity
ExecStopPost=/usr/bin/systemctl poweroff --force
UNIT
  ln -s ../checks.service "$2/etc/systemd/system/multi-user.target.wants/"
}
