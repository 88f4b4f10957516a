# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2154,SC2164 # CACHE and others are ./dev's, and so is set -e
#
# Read by ./dev: Ceres with Eigen alone, static, once for this machine and once for each target of
# the release files. Whoever links it needs find_package(Ceres CONFIG REQUIRED) and nothing else:
# every build is told where its own is (Ceres_DIR).

CERES_VERSION=2.1.0-2 # the last number counts the changes to build_ceres
CERES=$CACHE/ceres-$CERES_VERSION

# ceres_of TARGET: the folder of the Ceres that the release files for TARGET link.
ceres_of() { echo "$CACHE/$1-ceres-$CERES_VERSION"; }

need_ceres() {
  [ -d "$(ceres_of "$1")" ] ||
    QUIET='' step "Build Ceres for $1 (once)" for_target "$1" build_ceres_of "$1"
}

build_ceres_of() {
  target=$1
  shift
  build_ceres "$(ceres_of "$target").part" "$@"
  check_ceres "$target" "$@"
  mv "$(ceres_of "$target").part" "$(ceres_of "$target")"
}

# build_ceres FOLDER [CMAKE OPTION...]: Debian's own source without its choice of libraries: Eigen
# alone, static, position independent, and silent (-3 leaves only what ends the program; by default
# every solve prints to stderr).
build_ceres() {
  installed=$1
  shift
  work=$(mktemp -d "$CACHE/ceres.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  apt_of "$work" deb-src bookworm source ceres-solver=2.1.0+really2.1.0+dfsg-1
  cmake -S "$work"/ceres-solver-*/ -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_CXX_FLAGS="-g0 -ffile-prefix-map=$work=." \
    -DMINIGLOG=ON -DMINIGLOG_MAX_LOG_LEVEL=-3 -DGFLAGS=OFF -DSUITESPARSE=OFF -DCXSPARSE=OFF \
    -DLAPACK=OFF -DEIGENSPARSE=ON -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_SHARED_LIBS=OFF \
    -DBUILD_TESTING=OFF -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF "$@"
  cmake --build "$work/build"
  cmake --install "$work/build" --prefix "$work/installed"
  rm -rf "$installed"
  mv "$work/installed" "$installed"
}

# check_ceres TARGET [CMAKE OPTION...]: a program that solves links it, and runs where this machine
# can run it.
check_ceres() {
  ceres=$(ceres_of "$1").part
  runs=$1
  shift
  cmake -S "$ROOT/.dev/packaging/ceres" -B "$work/solve" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCeres_DIR="$ceres/lib/cmake/Ceres" "$@"
  cmake --build "$work/solve"
  [ "$runs" != linux-x64 ] || "$work/solve/solve"
}
