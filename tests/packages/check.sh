#!/usr/bin/env bash
# The Debian packages in a fresh Debian 12: check.sh BUILD SOURCE. Builds the packages of the build tree BUILD, installs
# them into a root made by debootstrap, runs the program, Python and a consumer there, and removes them again.
# Exit code 77 (skipped) where it is not run as root or debootstrap is missing.
set -euo pipefail
build=$(readlink -f "$1")
source=$(readlink -f "$2")
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap dpkg-shlibdeps >/dev/null; then
  echo "skipped: needs root, debootstrap and dpkg-dev"
  exit 77
fi

(cd "$build" && cpack >cpack.log 2>&1) || { cat "$build/cpack.log"; exit 1; }
packages=("$build"/packages/*.deb)
echo "packages: ${packages[*]##*/}"
if command -v lintian >/dev/null; then
  lintian --fail-on error --no-tag-display-limit --suppress-tags bad-distribution-in-changes-file "${packages[@]}" ||
    { echo "lintian finds errors"; exit 1; }
fi

root=$(mktemp -d)
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
finish() {
  for place in proc dev; do mountpoint -q "$root/$place" && umount "$root/$place"; done
  rm -rf --one-file-system "$root"
}
trap finish EXIT
# The machine's own sources and proxy settings, so that packages come from where they usually do.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$build/debootstrap.log" 2>&1 || { tail "$build/debootstrap.log"; exit 1; }
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
mkdir "$root/packages"
cp "${packages[@]}" "$root/packages/"
inside apt-get update -qq
inside sh -c 'apt-get install -y -qq --no-install-recommends /packages/vantage_*.deb /packages/python3-vantage_*.deb >/dev/null'

inside sh -c 'cd && vantage --version && vantage reconstruct mug --quiet && test -s runs/mug/report.html && test -s runs/mug/mesh.ply'
inside python3 -c 'import vantage; print("Python module", vantage.__version__)'
for file in /usr/share/man/man1/vantage.1.gz /usr/share/man/man1/vantage-plan.1.gz \
  /usr/share/bash-completion/completions/vantage /usr/share/zsh/vendor-completions/_vantage \
  /lib/systemd/system/vantage-serve@.service; do
  inside test -s "$file" || { echo "$file is missing"; exit 1; }
done

inside sh -c 'apt-get install -y -qq --no-install-recommends cmake ninja-build g++ systemd /packages/libvantage-dev_*.deb >/dev/null'
inside systemd-analyze verify --man=no /lib/systemd/system/vantage-serve@.service
mkdir "$root/trial"; cp -r "$source/tests/consumer" "$root/trial/consumer"
inside sh -c 'cd /trial && cmake -G Ninja -S consumer -B build -DVANTAGE_SESSION=ON >/dev/null && cmake --build build >/dev/null && ./build/session'

inside sh -c 'apt-get purge -y -qq vantage python3-vantage libvantage-dev >/dev/null'
left=$(inside find /usr /etc /lib -path '*vantage*' 2>/dev/null || true)
[ -z "$left" ] || { echo "left behind after the purge:"; echo "$left"; exit 1; }
inside sh -c 'test -s ~/runs/mug/report.html'
echo "installed, ran and removed"
