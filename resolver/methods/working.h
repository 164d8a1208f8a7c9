// Working memory of one frame: planes that the next frame makes anew. Between frames nobody has them, so that of a
// run's methods only those that resolve at the time hold any.
//
//     Working<PlaneF> luma_;
//
//     const auto luma = luma_.take();         // empty, until `luma` goes
//     lumaPlane(in, kind, exec, *luma);
//     luma_.bytes()                           // of the last frame, for Method::stateBytes()
#pragma once
#include <cstddef>
#include <memory>
#include <utility>

namespace aa {

template <class P>
class Working {
    struct GiveBack {
        Working* from;
        void operator()(P*) const { from->bytes_ = std::exchange(from->planes_, P()).bytes(); }
    };

  public:
    using Taken = std::unique_ptr<P, GiveBack>;
    Taken take() { return {&planes_, GiveBack{this}}; }
    size_t bytes() const { return bytes_; }

  private:
    P planes_;
    size_t bytes_ = 0;
};

}  // namespace aa
