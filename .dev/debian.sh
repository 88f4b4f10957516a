# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2016,SC2086 # $(REPO_URI) is apt's
#
# Read by ./dev: packages and sources of any Debian, by apt with lists of its own, so that the
# system's stay as they are.

# apt_of FOLDER TYPE SUITE COMMAND...: runs apt-get COMMAND in FOLDER on that suite's packages (TYPE
# deb) or sources (deb-src).
apt_of() {
  cd "$1"
  mkdir -p lists/partial archives/partial
  echo "$2 $(debian_site) $3 main" >sources.list
  shift 3
  apt_with_own_lists update
  apt_with_own_lists "$@"
}

apt_with_own_lists() {
  apt-get -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null \
    -o Dir::State::Lists="$PWD/lists" -o Dir::Cache="$PWD" -o Acquire::Retries=3 \
    -o APT::Sandbox::User="$(id -un)" "$@"
}

# The server that this system's own packages come from.
debian_site() {
  site=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' \
    'Codename: bookworm' 'Component: main' | head -n 1)
  echo "${site:-http://deb.debian.org/debian}"
}
