// Arrays of megabytes are asked for in pages of 2 MB: the system then answers a page fault for 512
// small ones, and the processor finds places that are far apart without walking through tables.
// Linux gives such pages to those who ask (tools/bench/NOTES.md has the figures); where it does
// not, nothing changes. A part of the program alone (see CMakeLists.txt): a library must not change
// how others allocate.
#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace
{

constexpr std::size_t large_page = std::size_t{1} << 21;
/// Smaller ones would leave too much of their last page unused.
constexpr std::size_t least = 8 * large_page;

void* allocate(std::size_t size, std::size_t alignment) noexcept
{
    if (size < least && alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__)
        return std::malloc(size > 0 ? size : 1);
    const std::size_t unit = size < least ? alignment : large_page;
    if (size > static_cast<std::size_t>(-1) - unit) return nullptr;
    void* const at = std::aligned_alloc(unit, std::max(unit, (size + unit - 1) & ~(unit - 1)));
    if (at != nullptr && size >= least) madvise(at, size, MADV_HUGEPAGE);
    return at;
}

void* allocate_or_throw(std::size_t size, std::size_t alignment)
{
    while (true)
    {
        if (void* const at = allocate(size, alignment)) return at;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}

} // namespace

void* operator new(std::size_t size)
{
    return allocate_or_throw(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}

/// alignment  at most 2 MB
void* operator new(std::size_t size, std::align_val_t alignment)
{
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}

void operator delete(void* at) noexcept
{
    std::free(at);
}

void operator delete(void* at, std::size_t) noexcept
{
    std::free(at);
}

void operator delete(void* at, std::align_val_t) noexcept
{
    std::free(at);
}

void operator delete(void* at, std::size_t, std::align_val_t) noexcept
{
    std::free(at);
}
