# Sourced by run.sh and service.sh: what a virtual machine with Debian's kernel and camera drivers is made of. All of it is
# kept in $cache. What is missing ends the script with a line that says what to do.

# require PACKAGE...: installed on this computer.
require() {
  local package missing=()
  for package in "$@"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null) == installed ]] || missing+=("$package")
  done
  ((${#missing[@]} == 0)) && return
  echo "$(basename "$0"): missing packages: apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 2
}

# The kernel's name, which changes with its ABI number.
kernel_abi() {
  local abi
  abi=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: linux-image-//p' | head -1)
  [[ -n $abi ]] || { echo "$(basename "$0"): apt knows no linux-image-amd64; apt-get update?" >&2; exit 2; }
  echo "$abi"
}

# get PACKAGE FOLDER: its files, without installing it.
get() {
  [[ -e $cache/$2.done ]] && return
  rm -rf "${cache:?}/$2"
  (cd "$cache" && apt-get download -q "$1" && dpkg-deb -x "$1"_*.deb "$2" && rm "$1"_*.deb)
  touch "$cache/$2.done"
}

# get_kernel ABI: to $cache/kernel-ABI.
get_kernel() {
  get "linux-image-$1" "kernel-$1"
  [[ -e $cache/kernel-$1/lib/modules/$1/modules.dep.bin ]] || depmod -b "$cache/kernel-$1" "$1"
}

# build ABI NAME FOLDER FILE [MAKE_OPTION...]: a module that Debian's kernel lacks, to $cache/NAME-ABI.ko.
build() {
  local abi=$1 name=$2 folder=$3 file=$4
  shift 4
  [[ -e $cache/$name-$abi.ko ]] && return
  make -s -C "/usr/src/linux-headers-$abi" M="$folder" "$@" modules > "$cache/$name.log" 2>&1 ||
    { tail "$cache/$name.log" >&2; exit 2; }
  cp "$folder/$file" "$cache/$name-$abi.ko"
}

build_loopback() { # ABI
  get v4l2loopback-dkms loopback
  build "$1" v4l2loopback "$(echo "$cache"/loopback/usr/src/v4l2loopback-*)" v4l2loopback.ko
}

# begin_initramfs FOLDER: with a shell, and lists of modules to load: `early`, to reach the host, and `cameras`.
begin_initramfs() {
  rm -rf "$1"
  mkdir -p "$1"/{bin,modules,host,proc,sys,dev}
  cp /bin/busybox "$1/bin/"
  ln -s busybox "$1/bin/sh"
  : > "$1/modules/early"
  : > "$1/modules/cameras"
}

# add_modules INITRAMFS LIST KERNEL_FOLDER ABI MODULE...: the kernel's by name, with those that they need in their order;
# or files of our own.
add_modules() {
  local first=$1 list=$2 kernel=$3 abi=$4 module file name
  shift 4
  for module in "$@"; do
    if [[ $module == */* ]]; then
      name=$(basename "$module" "-$abi.ko").ko
      cp "$module" "$first/modules/$name"
      echo "$name" >> "$first/modules/$list"
      continue
    fi
    modprobe -d "$kernel" -S "$abi" --show-depends "$module" | while read -r _ file _; do
      [[ $file == /* ]] || continue
      name=$(basename "$file" .xz)
      grep -qx "$name" "$first"/modules/{early,cameras} && continue
      if [[ $file == *.xz ]]; then xz -dc "$file" > "$first/modules/$name"; else cp "$file" "$first/modules/$name"; fi
      echo "$name" >> "$first/modules/$list"
    done
  done
}

# start_machine SECONDS KERNEL_FOLDER ABI INITRAMFS APPEND [QEMU_OPTION...]: boots; the guest's console comes out.
# Never KVM: where it is nested it may hang without a word. The tests keep up with TCG. Not -cpu max either: QEMU 7.2 gathers
# by AVX2 from wrong places, which no processor does (edges_tests under qemu-x86_64 -cpu max).
start_machine() {
  local seconds=$1 kernel=$2 abi=$3 first=$4 append=$5
  shift 5
  (cd "$first" && find . | cpio --quiet -o -H newc | gzip -1) > "$first.gz"
  timeout "$seconds" qemu-system-x86_64 -accel tcg,thread=multi -cpu Nehalem -smp 2 -display none -no-reboot \
    -kernel "$kernel/boot/vmlinuz-$abi" -initrd "$first.gz" -append "console=ttyS0 panic=-1 quiet $append" \
    "$@" -serial stdio -monitor none < /dev/null
}

# share NAME FOLDER [OPTION]: a folder of the host that the guest mounts by 9p (QEMU's options, a line each).
share() {
  printf '%s\n' -fsdev "local,id=$1,path=$2,security_model=none,multidevs=remap${3:+,$3}" \
    -device "virtio-9p-pci,fsdev=$1,mount_tag=$1"
}
