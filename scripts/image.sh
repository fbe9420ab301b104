#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes an OCI image of `kelpie live` with its page, for a vehicle's companion computer; the labels
# are those of a BlueOS extension (docs/howto/bluerov2.md). Everything in the image is a Debian package:
#   scripts/packages.sh
#   scripts/image.sh build/packages/kelpie-tools_*.deb out/image
# Needs root and the Debian packages mmdebstrap, umoci and dpkg; for another architecture
# qemu-user-static and binfmt-support as well. The architecture is the package's.
set -euo pipefail

if [ $# -ne 2 ]; then
  echo "usage: scripts/image.sh KELPIE_TOOLS.deb FOLDER" >&2
  exit 2
fi
deb=$(realpath "$1") out=$2
source=$(realpath "$(dirname "$0")/..")
[ -e "$out" ] && { echo "$out: exists; name a new folder" >&2; exit 2; }
architecture=$(dpkg-deb --field "$deb" Architecture)
version=$(dpkg-deb --field "$deb" Version)
stage=$(mktemp -d -p /tmp)
trap 'rm -rf "$stage"' EXIT
cp "$deb" "$stage/"

# Nothing of this machine stays: the package's place is below /tmp, and a container has its own names.
mmdebstrap --quiet --mode=root --variant=apt --architectures="$architecture" \
  --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
  --include="$stage/$(basename "$deb")" \
  --customize-hook='rm -rf "$1"/tmp/* "$1"/var/lib/apt/lists/* "$1"/var/cache/apt/*' \
  --customize-hook='rm -f "$1"/etc/hostname "$1"/etc/resolv.conf' \
  --customize-hook="install -D -m 755 '$source/scripts/image_start.sh' \"\$1/usr/bin/kelpie-start\"" \
  bookworm "$stage/root"

umoci init --layout "$out"
umoci new --image "$out:latest"
umoci unpack --image "$out:latest" "$stage/bundle"
cp -a "$stage/root/." "$stage/bundle/rootfs/"
umoci repack --image "$out:latest" "$stage/bundle"
permissions='{"NetworkMode": "host", "HostConfig": {"NetworkMode": "host",
  "Binds": ["/usr/blueos/extensions/kelpie:/data:rw"]}}'
umoci config --image "$out:latest" --architecture "$architecture" --os linux \
  --config.entrypoint /usr/bin/kelpie-start --config.workingdir /data --config.volume /data \
  --config.label "version=$version" --config.label "permissions=$permissions" \
  --config.label 'authors=[{"name": "The kelpie developers", "email": "developers@kelpie.invalid"}]' \
  --config.label 'company={"name": "kelpie", "about": "", "email": "developers@kelpie.invalid"}' \
  --config.label "type=other" --config.label 'tags=["navigation", "data-collection"]' \
  --config.label "requirements=core >= 1.1"
umoci gc --layout "$out"
echo "$out: an image for $architecture, kelpie $version, $(du -sh "$out" | cut -f1)"
