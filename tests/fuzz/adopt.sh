#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# tests/fuzz/adopt.sh FORMAT: takes what `./dev fuzz` found into the corpus, as fuzz_NNNN. Of the
# inputs below 4 kB that together reach what the made files do not, 40 of all sizes.
set -eu
cd "$(dirname "$(readlink -f "$0")")/../.."
format=$1
case $format in database) ending=smdb ;; model) ending=smmodel ;; *) ending=$format ;; esac
corpus=tests/fuzz/corpus/$format
rm -f "$corpus"/fuzz_*
chosen=$(mktemp -d)
trap 'rm -rf "$chosen"' EXIT
cp "$corpus"/* "$chosen"
"build/fuzz/tests/fuzz/fuzz_$format" -set_cover_merge=1 "$chosen" "build/fuzz/found/$format" \
  >"build/fuzz/$format.merge.log" 2>&1
number=0
for name in $(find "$chosen" -type f ! -name '*.*' -size -8 -printf '%s %f\n' | sort -n |
  awk '{ names[NR] = $2 } END { for (i = 1; i <= 40 && i <= NR; i++) print names[int(i * NR / 40)] }'); do
  number=$((number + 1))
  cp "$chosen/$name" "$corpus/$(printf 'fuzz_%04d.%s' "$number" "$ending")"
done
echo "$corpus: $number files called fuzz_NNNN"
