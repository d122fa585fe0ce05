# SPDX-License-Identifier: Apache-2.0
# Source this after `make build`, from any bash shell and any folder:
#     source /path/to/this/folder/setup.bash
# It puts this folder's Python, ROS 2 and nodes first in the environment. Sourcing it again changes nothing.

_eel_root="$(cd "$(dirname "${BASH_SOURCE[0]}")" > /dev/null && pwd -P)"

# _eel_path NAME ENTRY...: the variable's present entries, with ENTRY... first, without doubles, without a sourced /opt/ros
# (its Python packages are for another interpreter than this folder's).
_eel_path() {
    local name="$1" entry seen=":" rest="${!1-}" result=""
    shift
    while [ -n "$rest" ]; do
        set -- "$@" "${rest%%:*}"
        case "$rest" in *:*) rest="${rest#*:}" ;; *) rest="" ;; esac
    done
    for entry in "$@"; do
        case "$entry" in "" | /opt/ros/*) continue ;; esac
        case "$seen" in *":$entry:"*) continue ;; esac
        seen="$seen$entry:"
        result="${result:+$result:}$entry"
    done
    export "$name=$result"
}

_eel_setup() {
    local root="$1" package site
    if [ ! -x "$root/.venv/bin/python" ] || [ ! -d "$root/install/eel_msgs" ]; then
        echo "setup.bash: not built yet, run: make -C '$root' build" >&2
        return 1
    fi
    case "${AMENT_PREFIX_PATH-}" in
        */opt/ros/*) echo "setup.bash: leaving the sourced /opt/ros out of this shell (this folder brings its own ROS 2)" >&2 ;;
    esac
    for site in "$root"/.venv/lib/python3.*/site-packages; do
        site="lib/${site#"$root"/.venv/lib/}"
        break
    done

    local prefixes=() modules=()
    local libraries=("$root"/install/{eel_msgs,tf2_msgs}/lib "$root/.venv/lib" "$root/.venv/$site"/ros_*.libs)
    for package in eel_gym eel_studies eel_viz eel_dynamics eel_gaits eel_common; do
        prefixes+=("$root/install/$package")
        modules+=("$root/build/$package" "$root/install/$package/$site")
    done
    for package in eel_core eel_msgs tf2_msgs; do
        prefixes+=("$root/install/$package")
        modules+=("$root/install/$package/$site")
    done
    _eel_path PATH "$root/install/bin" "$root/.venv/bin"
    _eel_path AMENT_PREFIX_PATH "${prefixes[@]}" "$root/.venv"
    _eel_path PYTHONPATH "${modules[@]}"
    _eel_path LD_LIBRARY_PATH "${libraries[@]}"
    unset PYTHONHOME
    export ROS_DISTRO=jazzy ROS_VERSION=2 ROS_PYTHON_VERSION=3
    # Whoever is in the ROS domain may steer the nodes: by default, this machine alone. SUBNET is ROS's own default.
    export ROS_AUTOMATIC_DISCOVERY_RANGE="${ROS_AUTOMATIC_DISCOVERY_RANGE-LOCALHOST}"
    # The ROS wheels restart every Python once to set LD_LIBRARY_PATH, unless this says that it is set.
    export _ROS_WHEELS_BOOTSTRAP_COMPLETE=1
}

if _eel_setup "$_eel_root"; then
    unset -f _eel_path _eel_setup
    unset _eel_root
else
    unset -f _eel_path _eel_setup
    unset _eel_root
    return 1
fi
