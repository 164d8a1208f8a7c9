#!/bin/sh
# Fails when a kernel object holds a weak symbol outside its instruction set's namespace: the linker would merge it with
# the same symbol of another instruction set.
shared=$("${NM:-nm}" -C "$@" | grep -E ' [WVu] ' | grep -v -E " [WVu] ([a-z]+ )?${ARCH}::" | grep -v ' DW.ref' | grep -v __odr_asan)
if [ -n "$shared" ]; then
    echo "weak symbols outside namespace ${ARCH}:"
    echo "$shared" | sort -u | head -20
    exit 1
fi
# Two kernel files that name a function alike: the linker would keep one and run it for both.
twice=$("${NM:-nm}" -C --defined-only "$@" | grep -E " [WVu] ([a-z]+ )?${ARCH}::" | sed 's/^[0-9a-f]* //' | sort | uniq -d)
if [ -n "$twice" ]; then
    echo "functions of one name in two kernel files of ${ARCH}:"
    echo "$twice" | head -20
    exit 1
fi
