# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2016,SC2153,SC2154 # some $ are for inner programs; ROOT is ./dev's
#
# Read by ./dev: Blenders of a later Debian, each in a Debian of its own.

# need_root FOLDER SUITE: a Debian of its own that holds a Blender and the headers of its CPython.
need_root() {
  need_packages debootstrap
  [ -d "$1" ] || QUIET='' step "Install Blender in a root of Debian $2" make_root "$1" "$2"
}

make_root() {
  root=$1.part
  as_root rm -rf "$root"
  as_root debootstrap --variant=minbase "$2" "$root"
  as_root cp -a /etc/apt/apt.conf.d "$root/etc/apt/"
  as_root cp -L /etc/resolv.conf "$root/etc/"
  # python3-cattr and -requests: Blender's extensions import them, unstable's package forgets them.
  apt_install in_root blender python3-numpy libgl1-mesa-dri python3-cattr python3-requests
  in_root sh -c 'set -e; mkdir /headers; cd /headers
    python3 -c "import sys; print(*sys.version_info[:2], sep=chr(46))" >version
    apt-get -o APT::Sandbox::User=root download "libpython$(cat version)-dev"
    dpkg-deb -x ./*.deb .'
  as_root mv "$root" "$1"
}

# in_root COMMAND...: in the folder $root, as root, with this machine's files where they are.
in_root() {
  as_root unshare --mount --propagation private sh -c 'set -e
    mount -t proc proc "$0/proc"
    for folder in /dev /tmp "$1" "$2"; do
      mkdir -p "$0$folder"
      mount --rbind "$folder" "$0$folder"
    done
    cd "$2"
    shift 2
    exec chroot "$0" env -C "$PWD" PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"' \
    "$root" "$HOME" "$ROOT" "$@"
}
