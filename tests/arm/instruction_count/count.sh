#!/bin/bash
# Instructions of tracking a frame, by QEMU's user mode (Debian package qemu-user, whose build takes plugins), on 64-bit ARM and
# on x86-64 with vectors of the same width (Nehalem: SSE4).
#
#     count.sh RECORDING ARM_PROGRAM ARM_SYSROOT X86_PROGRAM     the programs: `edgeslam`, not stripped
set -euo pipefail
recording=$1 arm_program=$2 arm_sysroot=$3 x86_program=$4
folder=$(dirname "${BASH_SOURCE[0]}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

g++ -std=c++17 -O2 -shared -fPIC -fvisibility=hidden -o "$work/count.so" "$folder/count_instructions.cpp"
plugin=$work/count.so,function=14TrackingWorker7process,caller=11LockstepRun7process
echo "aarch64"
qemu-aarch64 -L "$arm_sysroot" -plugin "$plugin" "$arm_program" replay "$recording" --output "$work/result" 2>&1 | tail -5
echo "x86-64"
qemu-x86_64 -cpu Nehalem -plugin "$plugin" "$x86_program" replay "$recording" --output "$work/result" 2>&1 | tail -5
