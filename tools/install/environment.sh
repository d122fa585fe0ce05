# SPDX-License-Identifier: Apache-2.0
# Sourced by build.sh and run.sh: takes whatever ROS 2 or Python workspace the calling shell has sourced out of the
# environment, so that this folder's own ROS 2 is the only one in sight.

unset AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH AMENT_CURRENT_PREFIX PYTHONPATH PYTHONHOME VIRTUAL_ENV
unset ROS_DISTRO ROS_VERSION ROS_PYTHON_VERSION ROS_LOCALHOST_ONLY ROS_DISCOVERY_SERVER ROS_STATIC_PEERS RMW_IMPLEMENTATION
unset FASTRTPS_DEFAULT_PROFILES_FILE FASTDDS_DEFAULT_PROFILES_FILE _ROS_WHEELS_BOOTSTRAP_COMPLETE
unset MAKEFLAGS MAKELEVEL MFLAGS PIP_TARGET PIP_PREFIX
unset PYTHONDONTWRITEBYTECODE   # or each start of a node compiles numpy, rclpy and Rerun anew, which doubles its time

_without() {   # the entries of the path list $1 that lie neither in /opt/ros nor in this folder
    local entry result=""
    local IFS=:
    for entry in $1; do
        case "$entry/" in "/" | /opt/ros/* | "$root"/*) continue ;; esac
        result="${result:+$result:}$entry"
    done
    printf '%s' "$result"
}
PATH="$(_without "$PATH")"
LD_LIBRARY_PATH="$(_without "${LD_LIBRARY_PATH-}")"
[ -n "$LD_LIBRARY_PATH" ] || unset LD_LIBRARY_PATH
