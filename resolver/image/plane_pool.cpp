#include "image/plane_pool.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <new>
#include <vector>

namespace aa {
namespace {
constexpr std::align_val_t kAlignment{64};
// Smaller ones the allocator keeps by itself; larger ones leave holes between what a run keeps of each frame, 50 kB a
// frame of 64 x 36. Under AddressSanitizer it keeps all: it must see what is used too late.
#ifdef AA_SANITIZED
constexpr size_t kSmallest = ~size_t(0);
#else
constexpr size_t kSmallest = size_t(16) << 10;
#endif

// A mapping of its own for each, so that what is given back reaches the system. The allocator puts blocks of up to 32
// MB into its heap once such have been freed, where they leave holes between each other: 50 MB more with every frame of
// a run at 1920 x 1080 on one thread.
//
// Asks for pages of 2 MB, which a system may grant or not: of forty planes read side by side, a processor forgets where
// their pages of 4 kB lie before it reads the next piece of one. Such a page begins at a multiple of its size. Where
// the memory begins elsewhere, a quarter of a plane of 8 MB lies in pages of 4 kB.
//
// And of planes that all begin with a page the same pixel lies in the same set of each cache, which holds eight to
// twelve lines. So they begin in turn at sixteen places of a page.
constexpr size_t kPage = size_t(4) << 10, kHugePage = size_t(2) << 20;  // a page of the system is no smaller
constexpr size_t kTurns = 16, kFromTurns = 64 * kPage;                  // smaller planes would grow by too much

size_t mappedBytes(size_t bytes) {
    static const size_t page = size_t(::sysconf(_SC_PAGESIZE));
    return ((bytes >= kFromTurns ? bytes + kPage : bytes) + page - 1) / page * page;
}
void* map(size_t bytes) {
    const size_t whole = mappedBytes(bytes), before = bytes >= 2 * kHugePage ? kHugePage : 0;
    void* const memory = ::mmap(nullptr, before + whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    char* begin = static_cast<char*>(memory);
    if (before > 0) {
        const size_t skipped = (kHugePage - reinterpret_cast<uintptr_t>(begin) % kHugePage) % kHugePage;
        if (skipped > 0) ::munmap(begin, skipped);
        begin += skipped;
        ::munmap(begin + whole, kHugePage - skipped);
#ifdef MADV_HUGEPAGE
        ::madvise(begin, whole, MADV_HUGEPAGE);
#endif
    }
    static std::atomic<size_t> turn{0};
    return bytes >= kFromTurns ? begin + turn++ * 5 % kTurns * (kPage / kTurns) : begin;
}
void unmap(void* memory, size_t bytes) {
    char* const begin = static_cast<char*>(memory);
    ::munmap(begin - reinterpret_cast<uintptr_t>(begin) % kPage, mappedBytes(bytes));
}

class Pool {
  public:
    void* take(size_t bytes) {
        std::vector<Block> leaving;
        {
            const std::lock_guard one(mutex_);
            bytes_.used += bytes;
            bytes_.most = std::max(bytes_.most, bytes_.used);
            if (const auto found = unused_.find(bytes); found != unused_.end()) {
                void* const memory = found->second.back().memory;  // the last one may still be in the cache
                found->second.pop_back();
                if (found->second.empty()) unused_.erase(found);
                bytes_.unused -= bytes;
                return memory;
            }
            // What is of other sizes makes room.
            leaving = shrink(std::max(kUnusedPlaneBytes, bytes_.most) - bytes_.used);
        }
        giveBack(leaving);
        return map(bytes);
    }
    void give(void* memory, size_t bytes) {
        std::vector<Block> leaving;
        {
            const std::lock_guard one(mutex_);
            unused_[bytes].push_back({memory, bytes, ++time_});
            bytes_.used -= bytes, bytes_.unused += bytes;
            leaving = shrink(std::max(kUnusedPlaneBytes, bytes_.used));
        }
        giveBack(leaving);
    }
    PlaneBytes bytes() {
        const std::lock_guard one(mutex_);
        return bytes_;
    }

  private:
    struct Block {
        void* memory;
        size_t bytes;
        uint64_t since;  // it is unused
    };
    // To at most so many unused bytes, the oldest first.
    std::vector<Block> shrink(size_t most) {
        std::vector<Block> leaving;
        while (bytes_.unused > most) {
            const auto oldest = std::min_element(unused_.begin(), unused_.end(), [](const auto& a, const auto& b) {
                return a.second.front().since < b.second.front().since;
            });
            leaving.push_back(oldest->second.front());
            bytes_.unused -= oldest->first;
            oldest->second.pop_front();
            if (oldest->second.empty()) unused_.erase(oldest);
        }
        return leaving;
    }
    static void giveBack(const std::vector<Block>& leaving) {
        for (const Block& b : leaving) unmap(b.memory, b.bytes);
    }

    std::mutex mutex_;
    std::map<size_t, std::deque<Block>> unused_;  // by size, of each the oldest first
    uint64_t time_ = 0;
    PlaneBytes bytes_;
};

// Never ended: planes of static lifetime give back their memory after everything else.
union KeptPool {
    Pool pool;
    KeptPool() : pool() {}
    ~KeptPool() {}
};
Pool& pool() {
    static KeptPool kept;
    return kept.pool;
}
}  // namespace

void* takePlaneMemory(size_t bytes) {
    return bytes < kSmallest ? ::operator new(bytes, kAlignment) : pool().take(bytes);
}
void givePlaneMemory(void* memory, size_t bytes) {
    if (bytes < kSmallest)
        ::operator delete(memory, kAlignment);
    else
        pool().give(memory, bytes);
}
PlaneBytes planeBytes() { return pool().bytes(); }

}  // namespace aa
