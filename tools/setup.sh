# Shared by ./demo and ./test: install what is missing, configure, build within the machine's memory.
# Sourced by bash with `set -euo pipefail` in the root of the checkout.

build_packages=(g++ cmake ninja-build git ca-certificates libcgal-dev libeigen3-dev libtbb-dev tao-pegtl-dev libmpfi-dev nlohmann-json3-dev libcli11-dev)
# What the Python module and its tests take beside.
python_packages=(python3-dev python3-numpy pybind11-dev python3-pytest python3-hypothesis)

# The checkout may belong to somebody else (a container's mount): git would refuse to tell its commit.
export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0=$(pwd -P)

step() { printf '\n== %s\n' "$1"; }

# install_missing PACKAGE...: asks dpkg first, so that nothing is fetched when all is there.
install_missing() {
  local missing=() package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if ! command -v apt-get >/dev/null; then
    echo "Missing: ${missing[*]} (names of Debian 12 packages). Install them and run this again." >&2
    exit 1
  fi
  if [ "$(id -u)" -ne 0 ]; then
    echo "Some packages are missing. Install them as root, then run this again:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends -y ${missing[*]}" >&2
    exit 1
  fi
  step "Installing ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get update -qq
  apt-get install -qq -y --no-install-recommends "${missing[@]}" >/dev/null
}

# jobs_for MEGABYTES: parallel compilations of that size that fit the free memory, at most one per processor.
jobs_for() {
  local available limit jobs
  available=$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  [[ $limit =~ ^[0-9]+$ ]] && [ $((limit / 1048576)) -lt "$available" ] && available=$((limit / 1048576))
  jobs=$((available / $1))
  [ "$jobs" -gt "$(nproc)" ] && jobs=$(nproc)
  [ "$jobs" -lt 1 ] && jobs=1
  echo "$jobs"
}

# configure FOLDER OPTION...: prints only when something goes wrong.
configure() {
  local folder=$1 log launcher=()
  shift
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  # A build folder that came along with a moved checkout would be refused by CMake.
  if [ -e "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$(pwd -P)" "$folder/CMakeCache.txt"; then
    rm -rf "$folder"
  fi
  mkdir -p "$folder"
  log=$folder/configure.log
  if ! cmake -S . -B "$folder" -G Ninja "${launcher[@]}" "$@" >"$log" 2>&1; then
    cat "$log" >&2
    exit 1
  fi
}

# build FOLDER MEGABYTES_PER_UNIT [TARGET...]
build() {
  local folder=$1 jobs
  jobs=$(jobs_for "$2")
  shift 2
  # Ninja's one line of progress on a terminal; elsewhere only what went wrong.
  if [ -t 1 ]; then
    cmake --build "$folder" -j "$jobs" ${1:+--target "$@"}
  else
    echo "some minutes, the first time; $folder/build.log tells how far it is"
    if ! cmake --build "$folder" -j "$jobs" ${1:+--target "$@"} >"$folder/build.log" 2>&1; then
      tail -n 200 "$folder/build.log" >&2
      exit 1
    fi
  fi
}

run_ctest() {
  ctest --test-dir "$1" --output-on-failure --no-tests=error -j "$(jobs_for 500)"
}
