#!/usr/bin/env bash
# The Debian packages in a fresh Debian 12: check.sh BUILD SOURCE. Makes the packages of the build tree BUILD, installs
# them into a root made by debootstrap, runs the program, Python and a consumer there, and removes them again.
# Exit code 77 (skipped) where it is not run as root, debootstrap is missing or the mirror cannot be reached.
set -euo pipefail
build=$(readlink -f "$1")
source=$(readlink -f "$2")
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*"; exit 1; }
began=$SECONDS
say() { echo "$((SECONDS - began)) s: $*"; }

[ "$(id -u)" -eq 0 ] || skip "needs root"
for tool in debootstrap dpkg-shlibdeps; do
  command -v $tool >/dev/null || skip "needs the Debian packages debootstrap and dpkg-dev ($tool is missing)"
done

rm -rf "$build/packages"
(cd "$build" && cpack >cpack.log 2>&1) || { cat "$build/cpack.log"; fail "no packages"; }
packages=("$build"/packages/*.deb)
say "packages: ${packages[*]##*/}"
if command -v lintian >/dev/null; then
  lintian --fail-on error --no-tag-display-limit --suppress-tags bad-distribution-in-changes-file "${packages[@]}" ||
    fail "lintian finds errors"
  say "lintian finds no errors"
fi

root=$(mktemp -d)
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
finish() {
  for place in proc dev var/cache/apt/archives; do mountpoint -q "$root/$place" && umount "$root/$place"; done
  rm -rf --one-file-system "$root"
}
trap finish EXIT
log=$build/packages.log
# apt COMMAND...: as apt-get in the root. Skips the test where files cannot be fetched, fails otherwise.
apt() {
  inside apt-get -y -qq -o Acquire::Retries=2 "$@" >"$log" 2>&1 && return
  tail -n 20 "$log"
  if grep -qE "Failed to fetch|Temporary failure|Could not (resolve|connect)|Unable to connect" "$log"; then
    skip "the mirror $mirror cannot be reached"
  fi
  fail "apt-get $*"
}

# The machine's own sources and proxy settings, so that packages come from where they usually do.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
[ -n "$mirror" ] || skip "no mirror in the machine's sources"
mkdir -p "$build/debootstrap"
debootstrap --variant=minbase --cache-dir="$build/debootstrap" bookworm "$root" "$mirror" >"$log" 2>&1 || {
  tail -n 5 "$log"
  skip "debootstrap cannot make a fresh Debian from $mirror"
}
say "fresh Debian 12"
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast"  # the root is thrown away
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
mount --bind "$build/debootstrap" "$root/var/cache/apt/archives"
echo 'Binary::apt-get::APT::Keep-Downloaded-Packages "true";' >"$root/etc/apt/apt.conf.d/99keep"
mkdir "$root/packages"
cp "${packages[@]}" "$root/packages/"
apt update
package() { basename "$root/packages/$1"_*.deb; }
apt install --no-install-recommends "/packages/$(package vantage)" "/packages/$(package python3-vantage)"
say "vantage and python3-vantage installed"

inside sh -c 'cd && vantage --version && vantage reconstruct mug --quiet && test -s runs/mug/report.html && test -s runs/mug/mesh.ply' ||
  fail "the main job"
inside python3 -c 'import vantage; print("Python module", vantage.__version__)' || fail "import vantage"
for file in /usr/share/man/man1/vantage.1.gz /usr/share/man/man1/vantage-plan.1.gz \
  /usr/share/bash-completion/completions/vantage /usr/share/zsh/vendor-completions/_vantage \
  /lib/systemd/system/vantage-serve@.service; do
  inside test -s "$file" || fail "$file is missing"
done
inside sh -c 'vantage session new /var/lib/vantage/tray --box=0,0,0,1,1,1 >/dev/null' || fail "session new"

apt install --no-install-recommends cmake ninja-build g++ systemd "/packages/$(package libvantage-dev)"
say "libvantage-dev, a compiler and systemd installed"
inside systemd-analyze verify --man=no /lib/systemd/system/vantage-serve@.service || fail "the service"
mkdir "$root/trial"
cp -r "$source/tests/consumer" "$root/trial/consumer"
inside sh -c 'cd /trial && cmake -G Ninja -S consumer -B build -DVANTAGE_SESSION=ON >log 2>&1 && cmake --build build >>log 2>&1 && ./build/session' ||
  { tail -n 30 "$root/trial/log"; fail "the C++ consumer"; }
say "a consumer is built"

apt remove vantage python3-vantage libvantage-dev
inside sh -c 'command -v vantage' && fail "vantage is there after its removal"
inside dpkg --purge vantage python3-vantage libvantage-dev 2>/dev/null  # apt knows them no more: nothing was left to purge
left=$(inside find /usr /etc /lib /opt /var -path '*vantage*' -not -path '/var/lib/vantage*' -not -path '/var/cache/*' 2>/dev/null || true)
[ -z "$left" ] || fail "left behind after the purge: $left"
inside sh -c 'test -s ~/runs/mug/report.html && test -s /var/lib/vantage/tray/session/options.yaml' || fail "data are gone"
say "installed, ran and removed"
