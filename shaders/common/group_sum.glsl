// The sum over a workgroup of 256 invocations, in a fixed order: the same result on every run. Sums over subgroups
// would depend on the device's width.
#ifndef AA_GROUP_SUM
#define AA_GROUP_SUM

const uint GROUP_INVOCATIONS = 256;
shared float groupSumOf[GROUP_INVOCATIONS];

// Every invocation calls it, those beyond the picture with 0; the first one gets the sum.
float groupSum(float value) {
    const uint own = gl_LocalInvocationIndex;
    barrier();  // a sum before this one has been read
    groupSumOf[own] = value;
    for (uint stride = GROUP_INVOCATIONS / 2; stride > 0; stride /= 2) {
        barrier();
        if (own < stride) groupSumOf[own] += groupSumOf[own + stride];
    }
    return groupSumOf[0];
}
// Of a picture `width` px wide in workgroups of `groupWidth`, row by row.
uint groupNumber(int width, int groupWidth) {
    return gl_WorkGroupID.y * uint((width + groupWidth - 1) / groupWidth) + gl_WorkGroupID.x;
}

#endif
