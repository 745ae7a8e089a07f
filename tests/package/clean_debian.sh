# A clean Debian in a folder, where apt reaches the mirror as it does outside: its sources, its options for the network, proxies,
# certificates. Sourced by scripts that run as root.

# The sources of Debian that apt has here, for a suite: this system's, or another one from the same mirrors.
debian_sources() {
  local here
  here=$(. /etc/os-release && echo "$VERSION_CODENAME")
  apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' "Created-By: Packages" "Origin: Debian" |
    sed -n "s# $here\(-[a-z]*\)\? # $1\1 #p" | sort -u
}

# make_clean_debian SUITE FOLDER
make_clean_debian() {
  local suite=$1 root=$2 sources
  sources=$(debian_sources "$suite")
  apt-config dump | grep -E '^Acquire::(https?|Retries|Check-Valid-Until|Check-Date)\b.* ".+";' > "$root.network" || true
  mmdebstrap --variant=apt --quiet --include=ca-certificates --aptopt="$root.network" "$suite" "$root" ${sources:+"$sources"} > "$root.log" 2>&1 ||
    { tail "$root.log"; return 1; }
  if [[ -s /etc/ssl/certs/ca-certificates.crt ]]; then
    cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
  fi
  rm -f "$root.network" "$root.log"
  mount -t proc proc "$root/proc"
  inside "$root" apt-get update -qq
}

# inside FOLDER COMMAND [argument...]
inside() {
  local root=$1 proxies name
  shift
  proxies=()
  for name in http_proxy https_proxy no_proxy; do
    if [[ -n ${!name:-} ]]; then proxies+=("$name=${!name}"); fi
  done
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "${proxies[@]}" "$@"
}

# remove_clean_debian FOLDER
remove_clean_debian() {
  umount "$1/proc" 2> /dev/null || true
  rm -rf --one-file-system "$1" "$1.network" "$1.log"
}
