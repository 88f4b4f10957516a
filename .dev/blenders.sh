# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2016,SC2086,SC2153,SC2154 # some $ are for inner programs; ROOT is ./dev's
#
# Read by ./dev: Blenders with the release file installed; those of a later Debian each in a Debian
# of its own.

# verb_blender [VERSION [ARGS]]: opens that Blender with the add-on, installed anew from the release
# file as animators do. Its settings are kept in build/.
verb_blender() {
  version=${1:-3.4}
  [ $# -eq 0 ] || shift
  need_blender "$version"
  make_release_files --quick
  cd "$ROOT"
  home=$ROOT/build/blender-$version
  mkdir -p "$home/config" "$home/scripts"
  QUIET='' step "Install the add-on in Blender $version" install_addon "$version"
  run_blender "$@"
}

# verb_blenders: Blender's tests on the release file in every Blender, with windows.
verb_blenders() {
  if [ -z "${IN_XVFB:-}" ]; then
    basics $BLENDER_PACKAGES
    exec xvfb-run -a -s '-screen 0 1280x1024x24' env IN_XVFB=1 "$0" blenders "$@"
  fi
  python313=$(find_python313)
  locked "$CACHE/lock" need_bpy
  make_release_files --quick
  SYSTEM_PATH=$PATH
  for version in ${*:-3.4 4.3 5.2}; do
    need_blender "$version"
    suite "Blender $version" test_blender "$version"
  done
  [ $# -ne 0 ] || test_bpy
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}

# test_blender VERSION: in a user's folder of its own.
test_blender() {
  home=$(mktemp -d)
  trap 'rm -rf "$home"' EXIT
  cd "$ROOT"
  export SPARSE_MOCAP_TEST_PATH="$UNPACKED_WHEEL"
  [ -n "$runner" ] || export SPARSE_MOCAP_TEST_PYTHON="$VENV/bin/python" # for this Debian alone
  $runner timeout 1200 env HOME="$HOME" DISPLAY="${DISPLAY:-}" XAUTHORITY="${XAUTHORITY:-}" \
    BLENDER_USER_RESOURCES="$home" BLENDER_USER_CONFIG="$home" BLENDER_USER_SCRIPTS="$home" \
    SPARSE_MOCAP_PACKAGE="$(release_file_for "$1")" \
    blender -b --factory-startup --python-exit-code 1 --python "$ROOT/tests/blender/run.py"
}

# verb_index: the list by which Blender installs and updates the extension, beside the extension: a
# folder for any web server.
verb_index() {
  need_blender 4.3
  make_release_files
  repository=$ROOT/build/repository
  home=$ROOT/build/blender-4.3
  rm -rf "$repository"
  mkdir -p "$repository" "$home"
  cp "$(release_file_for 4.3)" "$repository/"
  QUIET='' step 'Make the index' run_blender --command extension server-generate \
    --repo-dir "$repository"
  ls "$repository"
}

# need_blender VERSION: that Blender, and in $runner and $root how commands reach it.
need_blender() {
  root=$(root_of "$1")
  case $1 in
    3.4)
      runner=''
      basics blender libgl1-mesa-dri python3-numpy
      return
      ;;
    4.3) suite=trixie ;;
    5.2) suite=sid ;;
    *) usage >&2 && exit 2 ;;
  esac
  runner=in_root
  basics
  locked "$CACHE/lock" need_root "$root" "$suite"
}

root_of() { echo "$CACHE/root-$1-2"; } # the last number counts the changes to make_blender_root
has_root() { [ -d "$(root_of "$1")" ]; }

install_addon() {
  release_file=$(release_file_for "$1")
  case $1 in
    3.4)
      run_blender -b --python-exit-code 1 --python "$ROOT/.dev/install_addon.py" -- "$release_file"
      ;;
    *) run_blender --command extension install-file -r user_default -e "$release_file" ;;
  esac
}

run_blender() {
  $runner env HOME="$HOME" DISPLAY="${DISPLAY:-}" XAUTHORITY="${XAUTHORITY:-$HOME/.Xauthority}" \
    BLENDER_USER_RESOURCES="$home" BLENDER_USER_CONFIG="$home/config" \
    BLENDER_USER_SCRIPTS="$home/scripts" blender "$@"
}

# need_root FOLDER SUITE: a Debian of its own that holds a Blender.
need_root() {
  need_packages debootstrap
  [ -d "$1" ] || QUIET='' step "Install Blender in a root of Debian $2" make_blender_root "$1" "$2"
}

# python3-cattr and -requests: Blender's extensions import them, unstable's package forgets them.
# libgl1: no package asks for it, and Blender opens no window without it.
make_blender_root() {
  make_root "$1" "$2" \
    blender python3-numpy libgl1 libgl1-mesa-dri python3-cattr python3-requests
}

# make_root FOLDER SUITE PACKAGE...: a Debian of that suite with these packages.
make_root() {
  made=$1
  suite_of_root=$2
  shift 2
  root=$made.part
  as_root rm -rf "$root"
  as_root debootstrap --variant=minbase "$suite_of_root" "$root"
  as_root cp -a /etc/apt/apt.conf.d "$root/etc/apt/"
  as_root cp -L /etc/resolv.conf "$root/etc/"
  apt_install in_root "$@"
  as_root mv "$root" "$made"
}

# in_root COMMAND...: in the folder $root, as root, with this machine's files where they are: those of
# the user, of the project, and the recorded motion that the tests read.
in_root() {
  as_root unshare --mount --propagation private sh -c 'set -e
    mount -t proc proc "$0/proc"
    for folder in /dev /tmp "$1" "$2" ${SPARSE_MOCAP_DATA:+"$SPARSE_MOCAP_DATA"}; do
      mkdir -p "$0$folder"
      mount --rbind "$folder" "$0$folder"
    done
    cd "$2"
    shift 2
    exec chroot "$0" env -C "$PWD" PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"' \
    "$root" "$HOME" "$ROOT" "$@"
}
