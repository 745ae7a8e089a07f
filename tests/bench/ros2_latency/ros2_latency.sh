#!/bin/bash
# From the publisher's call to a subscriber by Fast DDS, over the loopback of a network namespace: as root.
# usage: ros2_latency.sh BUILD_FOLDER [COUNT [RATE_HZ]]     UNDER: a command to run both ends under, as 'chrt --fifo 50'
set -euo pipefail
program=$(realpath "$1")/ros2_latency
count=${2:-10000}
rate=${3:-1000}
# shellcheck disable=SC2016
export UNDER=${UNDER:-}
exec unshare --net bash -c '
  ip link set lo up && ip route add 224.0.0.0/4 dev lo
  $UNDER "$0" receive "$1" &
  $UNDER "$0" publish "$1" "$2"
  wait $!' "$program" "$count" "$rate"
