// One line per method; it then appears in `list`, every property test, sweeps and reports.
#include "methods/geometry/dmsaa.h"
#include "methods/geometry/gbaa.h"
#include "methods/geometry/gpaa.h"
#include "methods/geometry/msaa.h"
#include "methods/geometry/rsaa.h"
#include "methods/geometry/sbaa.h"
#include "methods/geometry/sraa.h"
#include "methods/method.h"
#include "methods/reference/accum.h"
#include "methods/reference/noaa.h"
#include "methods/reference/resolve_filters.h"
#include "methods/reference/ssaa.h"
#include "methods/spatial/cmaa2.h"
#include "methods/spatial/deaa.h"
#include "methods/spatial/dlaa.h"
#include "methods/spatial/edge_blur.h"
#include "methods/spatial/fxaa.h"
#include "methods/spatial/mlaa.h"
#include "methods/spatial/smaa.h"
#include "methods/temporal/accum_reject.h"
#include "methods/temporal/asaa.h"
#include "methods/temporal/fsr2n.h"
#include "methods/temporal/inside.h"
#include "methods/temporal/karis.h"
#include "methods/temporal/master.h"
#include "methods/temporal/raptor.h"
#include "methods/temporal/t2msaa.h"
#include "methods/temporal/taa_simplest.h"
#include "methods/temporal/uncharted.h"

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
