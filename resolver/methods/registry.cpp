// One line per method; it then appears in `list`, every property test, sweeps and reports.
#include "methods/accum.h"
#include "methods/accum_reject.h"
#include "methods/asaa.h"
#include "methods/cmaa2.h"
#include "methods/deaa.h"
#include "methods/dlaa.h"
#include "methods/dmsaa.h"
#include "methods/edge_blur.h"
#include "methods/fxaa.h"
#include "methods/gbaa.h"
#include "methods/gpaa.h"
#include "methods/inside.h"
#include "methods/karis.h"
#include "methods/master.h"
#include "methods/method.h"
#include "methods/mlaa.h"
#include "methods/msaa.h"
#include "methods/noaa.h"
#include "methods/raptor.h"
#include "methods/resolve_filters.h"
#include "methods/rsaa.h"
#include "methods/sbaa.h"
#include "methods/smaa.h"
#include "methods/sraa.h"
#include "methods/ssaa.h"
#include "methods/t2msaa.h"
#include "methods/taa_simplest.h"
#include "methods/uncharted.h"
#include "methods/fsr2n.h"

namespace aa {

const std::vector<MethodDescriptor>& registry() {
    static const std::vector<MethodDescriptor> methods = {
        // reference
        noaaDescriptor(),
        accumDescriptor(),
        ssaaDescriptor(),
        resolveDescriptor(),
        // spatial
        fxaa1Descriptor(),
        fxaa311Descriptor(),
        fxaaCsDescriptor(),
        fxaaConsoleDescriptor(),
        mlaaDescriptor(),
        smaa1xDescriptor(),
        smaaS2xDescriptor(),
        cmaa2Descriptor(),
        dlaaDescriptor(),
        nfaaDescriptor(),
        ssssaaDescriptor(),
        deaaDescriptor(),
        // geometry
        msaaDescriptor(),
        csaaDescriptor(),
        dmsaaDescriptor(),
        gbaaDescriptor(),
        gpaaDescriptor(),
        d2eDescriptor(),
        sraaDescriptor(),
        sbaaDescriptor(),
        rsaaDescriptor(),
        // temporal
        smaaT2xDescriptor(),
        smaa4xDescriptor(),
        taaSimplestDescriptor(),
        unchartedDescriptor(),
        unchartedNormDescriptor(),
        unchartedNoSharpenDescriptor(),
        masterDescriptor(),
        asaaDescriptor(),
        t2msaaDescriptor(),
        accumRejectDescriptor(),
        raptorDescriptor(),
        donutDescriptor(),
        falcorDescriptor(),
        salviDescriptor(),
        karisDescriptor(),
        insideDescriptor(),
        fsr2nDescriptor(),
    };
    return methods;
}

}  // namespace aa
