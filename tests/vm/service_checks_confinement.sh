# Sourced by service_checks.sh: what the service may do, asked of the running process and tried in its place.

status_line() { # NAME VALUE_PATTERN
  measured=$(grep "^$1:" "/proc/$(process)/status" | tr '\t' ' ')
  [[ $measured =~ ^$1:\ *($2)$ ]]
}
in_group_video() { status_line Groups ".*\b$(getent group video | cut -d: -f3)\b.*"; }
# The state folder and the user are made when it starts.
own_user() {
  local uid
  uid=$(awk '/^Uid:/ {print $2}' "/proc/$(process)/status")
  measured="uid $uid"
  ((uid >= 61184 && uid <= 65519))
}

# Tried by root in the service's control group: what the kernel refuses there no right helps against.
in_its_place() {
  bash -c 'echo $$ > /sys/fs/cgroup/system.slice/edgeslam.service/cgroup.procs && eval "$1"' bash "$1" 2> refusal.txt
}
refused_there() { # a shell command that goes well elsewhere
  bash -c "$1" 2> /dev/null || { measured="not possible at all"; return 1; }
  ! in_its_place "$1" && measured=$(sed 's/.*: //' refusal.txt | tail -1) && [[ $measured == "Operation not permitted" ]]
}

devices_open() {
  measured=$(readlink "/proc/$(process)"/fd/* | grep '^/dev' | sort -u | paste -sd' ')
  [[ $measured == "/dev/null /dev/video42" ]]
}
real_time_threads() {
  measured=$(ps -L -o comm=,cls=,rtprio= -p "$(process)" | awk '$2 == "FF" {print $1, $3}' | paste -sd, | sed 's/,/, /g')
  [[ $measured == *capture* && $measured == *tracking* ]]
}
exposure() {
  measured=$(systemd-analyze security --no-pager --threshold=30 edgeslam | grep 'Overall exposure' | sed 's/.*: //')
  systemd-analyze security --no-pager --threshold=30 edgeslam > /dev/null
}

is_confined() {
  echo "-- confinement"
  check "a user of its own" own_user
  check "with the group of cameras" in_group_video
  local name
  for name in CapInh CapPrm CapEff CapBnd CapAmb; do check "no capability" status_line $name 0+; done
  check "none to be had" status_line NoNewPrivs 1
  check "a filter of system calls" status_line Seccomp 2
  check "the camera is the only device open" devices_open
  check "a camera can be opened there" in_its_place 'exec 3< /dev/video42'
  check "the disk cannot" refused_there 'exec 3< /dev/vda'
  check "nor the kernel's log" refused_there 'exec 3< /dev/kmsg'
  check "nor any memory" refused_there 'exec 3< /dev/mem'
  ip route add 192.0.2.1/32 dev lo
  check "multicast can be sent there" in_its_place 'echo > /dev/udp/239.255.76.67/7000'
  check "and heard there" in_its_place 'timeout 60 edgeslam listen --count 1 > /dev/null'
  check "to a computer elsewhere it cannot" refused_there 'echo > /dev/udp/192.0.2.1/7000'
  check "threads with real-time priority" real_time_threads
  check "memory is locked" status_line VmLck ' *[1-9][0-9]* kB'
  check "systemd's own rating, at most 3.0" exposure
}
