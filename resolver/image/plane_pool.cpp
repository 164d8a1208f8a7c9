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
#include <optional>
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
constexpr size_t kHasHugePages = 2 * kHugePage;                         // a block of at least so many bytes

size_t mappedBytes(size_t bytes) {
    static const size_t page = size_t(::sysconf(_SC_PAGESIZE));
    return ((bytes >= kFromTurns ? bytes + kPage : bytes) + page - 1) / page * page;
}
size_t hugeBytes(size_t bytes) { return bytes < kHasHugePages ? 0 : mappedBytes(bytes) / kHugePage * kHugePage; }

char* mapped(size_t bytes, char* at = nullptr) {
    void* const memory =
        ::mmap(at, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | (at ? MAP_FIXED : 0), -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return static_cast<char*>(memory);
}
char* mappedAtHugePage(size_t bytes) {
    char* begin = mapped(kHugePage + bytes);
    const size_t skipped = (kHugePage - reinterpret_cast<uintptr_t>(begin) % kHugePage) % kHugePage;
    if (skipped > 0) ::munmap(begin, skipped);
    begin += skipped;
    ::munmap(begin + bytes, kHugePage - skipped);
#ifdef MADV_HUGEPAGE
    ::madvise(begin, bytes, MADV_HUGEPAGE);
#endif
    return begin;
}

struct Pages {
    char* begin;
    size_t bytes;
};
void giveBack(const std::vector<Pages>& leaving) {
    for (const Pages& p : leaving) ::munmap(p.begin, p.bytes);
}
// A page of 2 MB comes to lie where another is mapped, with what it holds. One at a time: what was moved before is a
// mapping of its own, and the system moves nothing that lies in two.
void move([[maybe_unused]] char* page, [[maybe_unused]] char* to) {
#ifdef MREMAP_FIXED
    if (::mremap(page, kHugePage, kHugePage, MREMAP_MAYMOVE | MREMAP_FIXED, to) != MAP_FAILED) return;
    mapped(kHugePage, to);
#endif
    ::munmap(page, kHugePage);
}
// With the pages of `moving` side by side at its beginning, so that the system need not clear others.
char* map(size_t bytes, const std::vector<Pages>& moving) {
    const size_t whole = mappedBytes(bytes);
    char* const begin = bytes < kHasHugePages ? mapped(whole) : mappedAtHugePage(whole);
    char* to = begin;
    for (const Pages& p : moving)
        for (size_t done = 0; done < p.bytes; done += kHugePage, to += kHugePage) move(p.begin + done, to);
    return begin;
}
char* inTurn(char* begin, size_t bytes) {
    static std::atomic<size_t> turn{0};
    return bytes >= kFromTurns ? begin + turn++ * 5 % kTurns * (kPage / kTurns) : begin;
}
char* mappedAt(void* memory) {
    char* const begin = static_cast<char*>(memory);
    return begin - reinterpret_cast<uintptr_t>(begin) % kPage;
}

class Pool {
  public:
    void* take(size_t bytes) {
        std::vector<Pages> moving, leaving;
        size_t before;
        {
            const std::lock_guard one(mutex_);
            if (void* const memory = ofItsSize(bytes)) return memory;
            before = bytes_.most;
            use(bytes);
            moving = pages(hugeBytes(bytes), leaving);
            shrink(std::max(kUnusedPlaneBytes, bytes_.most) - bytes_.used, leaving);
        }
        giveBack(leaving);
        try {
            return inTurn(map(bytes, moving), bytes);
        } catch (const std::bad_alloc&) {
            giveBack(moving);
            refused(bytes, before);
            throw;
        }
    }
    void give(void* memory, size_t bytes) {
        std::vector<Pages> leaving;
        {
            const std::lock_guard one(mutex_);
            unused_[bytes].push_back({memory, ++time_});
            bytes_.used -= bytes, bytes_.unused += bytes;
            shrink(std::max(kUnusedPlaneBytes, bytes_.used), leaving);
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
        uint64_t since;  // it is unused
    };
    void use(size_t bytes) {
        bytes_.used += bytes;
        bytes_.most = std::max(bytes_.most, bytes_.used);
    }
    void* ofItsSize(size_t bytes) {
        const auto found = unused_.find(bytes);
        if (found == unused_.end()) return nullptr;
        void* const memory = found->second.back().memory;  // the last one may still be in the cache
        found->second.pop_back();
        if (found->second.empty()) unused_.erase(found);
        bytes_.unused -= bytes;
        use(bytes);
        return memory;
    }
    // The oldest of unused blocks of at least so many bytes; it counts as unused no longer.
    std::optional<Pages> oldest(size_t least) {
        auto found = unused_.end();
        for (auto i = unused_.lower_bound(least); i != unused_.end(); ++i)
            if (found == unused_.end() || i->second.front().since < found->second.front().since) found = i;
        if (found == unused_.end()) return {};
        const Pages whole{mappedAt(found->second.front().memory), mappedBytes(found->first)};
        bytes_.unused -= found->first;
        found->second.pop_front();
        if (found->second.empty()) unused_.erase(found);
        return whole;
    }
    // So many bytes in pages of 2 MB, or what there are of them. What is left of a block's pages waits for the next.
    std::vector<Pages> pages(size_t bytes, std::vector<Pages>& leaving) {
        std::vector<Pages> found;
        while (bytes > 0) {
            if (spare_.empty()) {
                const std::optional<Pages> block = oldest(kHasHugePages);
                if (!block) break;
                const size_t huge = block->bytes / kHugePage * kHugePage;
                spare_.push_back({block->begin, huge}), bytes_.unused += huge;
                if (block->bytes > huge) leaving.push_back({block->begin + huge, block->bytes - huge});
            }
            Pages& last = spare_.back();
            const size_t taken = std::min(bytes, last.bytes);
            last.bytes -= taken, bytes -= taken, bytes_.unused -= taken;
            found.push_back({last.begin + last.bytes, taken});
            if (last.bytes == 0) spare_.pop_back();
        }
        return found;
    }
    // To at most so many unused bytes, the oldest first.
    void shrink(size_t most, std::vector<Pages>& leaving) {
        for (; bytes_.unused > most && !spare_.empty(); spare_.pop_back()) {
            leaving.push_back(spare_.back());
            bytes_.unused -= spare_.back().bytes;
        }
        while (bytes_.unused > most) leaving.push_back(*oldest(0));
    }
    // What is unused may be what was missing.
    void refused(size_t bytes, size_t most) {
        std::vector<Pages> leaving;
        {
            const std::lock_guard one(mutex_);
            bytes_.used -= bytes;
            bytes_.most = std::max(most, bytes_.used);
            shrink(0, leaving);
        }
        giveBack(leaving);
    }

    std::mutex mutex_;
    std::map<size_t, std::deque<Block>> unused_;  // by size, of each the oldest first
    std::vector<Pages> spare_;                    // of blocks that gave others their pages
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
