#!/bin/sh
# Is called as `blender` is called, and runs the Blender of the Debian system in root/ beside this file: debian.py puts a
# copy there. The system is entered in a mount namespace of its own, so nothing stays mounted however this ends, and the
# process becomes Blender itself, so that whoever kills it kills Blender.
set -eu
PATH=$PATH:/usr/sbin:/sbin  # where chroot is, and a user's PATH does not look
suite=$(dirname "$(readlink -f "$0")")
if [ "${AA_ENTERED:-}" != "$suite" ]; then
    # While this lock is shared nobody replaces or removes the system; it is given back with the process.
    if [ -e "$suite.lock" ]; then exec 9<"$suite.lock"; flock -s 9; fi
    as=""
    unshare --mount true 2>/dev/null || as="--user --map-root-user"
    # shellcheck disable=SC2086  # two words or none
    AA_ENTERED=$suite exec unshare $as --mount --propagation private "$0" "$@"
fi
unset AA_ENTERED
root=$suite/root
here=$(pwd -P)
# Settings of the user's own Blender are not ours to use or to change: a home that is empty each time.
mount -t tmpfs home "$root/root"
shared=:
share() { # FOLDER keeps its name inside
    case $shared in *:$1:*) return ;; esac
    shared=$shared$1:
    mkdir -p "$root$1"
    mount --rbind "$1" "$root$1"
}
# Folders that are used: this one, those of the arguments, the temporary one, AA_SHARE (with : between); as a whole
# /home, but nothing that the system inside has itself.
share_with_neighbours() {
    case $1 in
    /root/* | /var/* | /run/*) share "$1" ;;
    /root | /var | /run | /bin* | /boot* | /dev* | /etc* | /lib* | /proc* | /sbin* | /sys* | /usr* | /) ;;
    /*) top=${1#/}; share "/${top%%/*}" ;;
    esac
}
share /tmp
share_with_neighbours "$here"
for word; do
    case $word in /*) if [ -e "$word" ]; then share_with_neighbours "$(dirname "$word")"; fi ;; esac
done
IFS=:
for place in ${TMPDIR:-} ${AA_SHARE:-}; do share_with_neighbours "$place"; done
unset IFS
for place in /proc /sys /dev; do mount --rbind $place "$root$place"; done
unset LD_LIBRARY_PATH LD_PRELOAD PYTHONPATH PYTHONHOME LC_ALL XDG_CONFIG_HOME XDG_CACHE_HOME XDG_DATA_HOME
# shellcheck disable=SC2016  # for the shell inside
exec chroot "$root" /usr/bin/env HOME=/root LANG=C.UTF-8 PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin \
    sh -c 'cd "$1" && shift && exec "$@"' sh "$here" "$(basename "$0")" "$@"
