#!/bin/bash
# Runs a program of the cross build under QEMU.   usage: emulate.sh FOLDER PROGRAM [argument...]     77: it was not built.
set -euo pipefail
folder=$1
program=$folder/build/$2
shift 2

[[ -e $folder/sysroot.made && -x $program ]] || { echo "skipped: no $program"; exit 77; }
exec qemu-aarch64-static -L "$folder/sysroot" "$program" "$@"
