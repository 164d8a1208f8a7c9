#!/bin/sh
# What another machine needs to measure its card: the program, the libraries that it uses, the Vulkan loader and
# measure.sh, in one folder. tests/gpu/bundle.sh build/aaresolve FOLDER
set -eu
[ $# = 2 ] || { sed -n 2,3p "$0"; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2/lib"
cp "$1" "$2/program"
loader=$(ldconfig -p | sed -n 's/.*libvulkan\.so\.1 .*=> //p' | head -1)
{ ldd "$1" | sed -n 's/.*=> \(\/[^ ]*\).*/\1/p'; echo "$loader"; } | while read -r library; do
    case $library in
        */libc.so.* | */libm.so.* | */libpthread.so.* | */libdl.so.* | */ld-linux*) ;; # the other machine's own
        ?*) cp -L "$library" "$2/lib/" ;;
    esac
done
cat >"$2/aaresolve" <<'RUN'
#!/bin/sh
here=$(cd "$(dirname "$0")" && pwd)
LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "$here/program" "$@"
RUN
cp "$here/measure.sh" "$2/measure.sh"
chmod +x "$2/aaresolve" "$2/measure.sh"
du -sh "$2"
