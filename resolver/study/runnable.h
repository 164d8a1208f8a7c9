// What a shot can run.
#pragma once
#include <string>

#include "methods/spec.h"
#include "shot/reader.h"

namespace aa {

// Why the shot cannot serve the method, in half a sentence that stands without its subject ("its pictures at the pixel
// centres lack depth, subsamples"); empty: it can.
class Runnable {
  public:
    explicit Runnable(const ShotReader& shot);
    std::string whyNot(const MethodSpec& method) const;

  private:
    ShotInfo info_;
    bool split_;  // the shot holds pictures at the pixel centres beside jittered ones
    PassSet jittered_, centre_;
};

}  // namespace aa
