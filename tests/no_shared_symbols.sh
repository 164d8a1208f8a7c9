#!/bin/sh
# Fails when a kernel object holds a weak symbol outside its instruction set's namespace: the linker would merge it with
# the same symbol of another instruction set.
shared=$(nm -C "$@" | grep -E ' [WVu] ' | grep -v -E " [WVu] ([a-z]+ )?${ARCH}::" | grep -v ' DW.ref' | grep -v __odr_asan)
if [ -n "$shared" ]; then
    echo "weak symbols outside namespace ${ARCH}:"
    echo "$shared" | sort -u | head -20
    exit 1
fi
