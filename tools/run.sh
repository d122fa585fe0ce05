#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command in this folder's environment (setup.bash) and nothing else's, for the Makefile.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)"
cd "$root"
source tools/install/environment.sh
source setup.bash
export ROS_LOG_DIR="$root/out/log"   # not ~/.ros/log
exec "$@"
