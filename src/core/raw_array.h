#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace fppg
{

/// Leaves new values as they are in memory instead of writing them.
template <typename T>
struct RawAllocator : std::allocator<T>
{
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    template <typename U>
    struct rebind
    {
        using other = RawAllocator<U>;
    };

    void construct(T* /*value*/) const noexcept {}
    template <typename... Arguments>
    void construct(T* value, Arguments&&... arguments) const
    {
        std::construct_at(value, std::forward<Arguments>(arguments)...);
    }
};

/// A vector to whose n values nothing has been written, so that the threads which fill it bring its
/// pages in; a plain one does that on one thread. Values must be written before they are read.
template <typename T>
using RawArray = std::vector<T, RawAllocator<T>>;

} // namespace fppg
