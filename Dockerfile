# SPDX-License-Identifier: Apache-2.0
# The suite on ROS 2 Jazzy from apt:
#     docker build -t eel . && docker run --rm -it --network host eel ros2 run eel_dynamics dynamics
FROM ros:jazzy
SHELL ["/bin/bash", "-c"]
WORKDIR /workspace

# What apt has first; then, in a virtual environment over it, what the visualiser needs from pip.
COPY src src
RUN apt-get update \
    && apt-get install --yes --no-install-recommends python3-venv \
    && rosdep update --rosdistro jazzy \
    && rosdep install --from-paths src --ignore-src --rosdistro jazzy --dependency-types build --dependency-types buildtool \
        --dependency-types exec --skip-keys python3-rosbags-pip -y \
    && rm -rf /var/lib/apt/lists/*
COPY requirements.txt .
RUN python3 -m venv --system-site-packages /opt/eel \
    && /opt/eel/bin/pip install --no-cache-dir --require-hashes -r requirements.txt

# Binaries for every x86-64 machine: the image may run elsewhere than where it was built.
RUN source /opt/ros/jazzy/setup.bash && source /opt/eel/bin/activate \
    && if [ "$(uname -m)" = x86_64 ]; then levels='v2;v3;v4'; else levels=''; fi \
    && python -m colcon build --cmake-args -DBUILD_TESTING=OFF "-DEEL_CORE_LEVELS=$levels"

RUN printf '%s\n' '#!/bin/bash' 'source /opt/ros/jazzy/setup.bash' 'source /opt/eel/bin/activate' \
        'source /workspace/install/setup.bash' 'exec "$@"' > /eel_entrypoint.sh && chmod +x /eel_entrypoint.sh
# Whoever is in the ROS domain may steer the nodes: by default, this machine alone. For others too:
#     docker run -e ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET ...
ENV ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
ENTRYPOINT ["/eel_entrypoint.sh"]
CMD ["bash"]
