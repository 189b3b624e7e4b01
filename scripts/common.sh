# SPDX-License-Identifier: LGPL-2.1-or-later
# What the scripts share; they source it.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# stage TEXT COMMAND...: runs the command and says how long it took. Where the output is no terminal it goes to a log,
# of which the end is shown if the command fails.
stage()
{
  local text=$1 start=$SECONDS log
  shift
  if [ -t 1 ]; then
    echo "$text ..."
    "$@" || { echo "$text failed." >&2; return 1; }
  else
    mkdir -p "$root/build"
    log=$root/build/${text//[^A-Za-z0-9]/_}.log
    echo -n "$text ... "
    if ! "$@" > "$log" 2>&1; then
      echo "failed:"
      tail -n 60 "$log"
      echo "The whole output is in $log." >&2
      return 1
    fi
  fi
  echo "done in $((SECONDS - start)) s"
}

# as_root 'COMMANDS': runs them in a shell, by sudo where we are not root.
as_root()
{
  if [ "$(id -u)" = 0 ]; then
    bash -c "$1"
  elif command -v sudo > /dev/null; then
    echo "sudo may ask for your password." >&2
    sudo bash -c "$1"
  else
    echo "Run this as root, there is no sudo here to do it: $1" >&2
    return 1
  fi
}

# mpi RANKS COMMAND...: one rank runs without mpirun.
mpi()
{
  local ranks=$1
  shift
  if [ "$ranks" = 1 ]; then
    "$@"
  elif [ "$(id -u)" = 0 ]; then
    mpirun --allow-run-as-root --oversubscribe -n "$ranks" "$@"
  else
    mpirun --oversubscribe -n "$ranks" "$@"
  fi
}
