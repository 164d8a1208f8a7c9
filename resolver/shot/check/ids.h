// Does every object keep its id from frame to frame? The surfaces are followed along the motion: where an object lands
// whole on another id of the same depth, and that id has gone (or has wandered on itself), the objects were numbered
// anew. A wrong motion does not look like that: the id that it lands on is still there.
#pragma once
#include "shot/check/check.h"

namespace aa {

class IdCheck {
  public:
    // Both frames need object, depth and motion (zeros in a static shot). False: ids changed between the two, so that
    // nothing else can be judged by following them.
    bool add(const Frame& previous, const Frame& frame, CheckReport& report);
    bool changed() const { return found_; }

  private:
    bool found_ = false;
};

}  // namespace aa
