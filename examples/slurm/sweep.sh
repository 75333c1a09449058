#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# A sweep on a cluster with Slurm, from a folder that its nodes share: docs/guides/campaigns.md.
#   examples/slurm/sweep.sh [STUDY [DIR [OPTION...]]]     options of `shoal study run`, such as --partition short
# After any interruption the same command continues.
set -eu
study=${1:-coop_land_sweep}
out=${2:-results/coop_land_sweep}
if [ $# -gt 2 ]; then shift 2; else shift $#; fi
shoal study plan "$study" --output "$out"
shoal study run "$out" --engine slurm --chunk 10 "$@"
shoal study collect "$out" --show
