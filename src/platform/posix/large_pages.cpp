// Arrays of megabytes are asked for in pages of 2 MB: the system then answers a page fault for 512
// small ones, and the processor finds places that are far apart without walking through tables.
// Linux gives such pages to those who ask (tools/bench/NOTES.md has the figures); where it does
// not, nothing changes. A part of the program alone (see CMakeLists.txt): a library must not change
// how others allocate.
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace
{

constexpr std::size_t large_page = std::size_t{1} << 21;
/// Smaller ones would leave too much of their last page unused.
constexpr std::size_t least = 8 * large_page;

void* allocate(std::size_t size) noexcept
{
    if (size < least) return std::malloc(size > 0 ? size : 1);
    if (size > static_cast<std::size_t>(-1) - large_page) return nullptr;
    void* const at = std::aligned_alloc(large_page, (size + large_page - 1) & ~(large_page - 1));
    if (at != nullptr) madvise(at, size, MADV_HUGEPAGE);
    return at;
}

} // namespace

void* operator new(std::size_t size)
{
    while (true)
    {
        if (void* const at = allocate(size)) return at;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* at) noexcept
{
    std::free(at);
}

void operator delete(void* at, std::size_t) noexcept
{
    std::free(at);
}
