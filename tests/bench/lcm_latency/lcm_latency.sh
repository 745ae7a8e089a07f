#!/bin/bash
# Latency and loss over LCM: loopback, two hosts (namespaces joined by a cable, ttl 1), and with 5 % of the packets lost.
# As root, with iproute2 and nftables. usage: lcm_latency.sh PROGRAM [COUNT RATE_HZ]
# UNDER='chrt --fifo 50' runs both ends at that priority, as the service does, where others use the machine, too.
set -euo pipefail
program=$(realpath "$1") count=${2:-100000} rate=${3:-1000}

if [[ -z ${IN_OWN_NETWORK:-} ]]; then
  IN_OWN_NETWORK=1 exec unshare -n "$0" "$@"
fi
folder=$(mktemp -d)
ip link set lo up

unshare -n sleep infinity &
other=$!
trap 'kill $other; rm -rf "$folder"' EXIT
sleep 0.2
on_other() { nsenter --target "$other" --net "$@"; }
ip link add cable type veth peer name cable netns "$other"
ip address add 10.0.0.1/24 dev cable
ip link set cable up
on_other ip link set lo up
on_other ip address add 10.0.0.2/24 dev cable
on_other ip link set cable up
on_other ip route add 224.0.0.0/4 dev cable

# measure NAME TTL COUNT RATE [COMMAND...]: the receiver runs under COMMAND.
measure() {
  local name=$1 ttl=$2 messages=$3 at=$4
  shift 4
  echo "== $name: $messages frames at $at Hz, ttl $ttl"
  export LCM_DEFAULT_URL="udpm://239.255.76.67:7667?ttl=$ttl"
  "$@" ${UNDER:-env} "$program" receive > "$folder/received" &
  local receiver=$!
  until grep -q ready "$folder/received"; do sleep 0.1; done
  ${UNDER:-env} "$program" publish "$messages" "$at"
  wait $receiver
  grep -v ready "$folder/received"
}

ip route add 224.0.0.0/4 dev lo
measure "loopback" 0 "$count" "$rate" env
measure "loopback, as a camera" 0 900 30 env
ip route replace 224.0.0.0/4 dev cable
measure "two hosts" 1 "$((count / 10))" "$rate" on_other
on_other nft add table ip loss
on_other nft add chain ip loss input '{ type filter hook input priority 0; }'
on_other nft add rule ip loss input udp dport 7667 numgen random mod 100 '<' 5 drop
measure "two hosts, 5 % lost" 1 "$((count / 10))" "$rate" on_other
