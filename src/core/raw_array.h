#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace fppg
{

/// Room for n values that nothing has been written to, so that the threads which fill it bring its
/// pages in; a vector would do that on one. Values must be written before they are read.
template <typename T>
class RawArray
{
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    explicit RawArray(std::size_t n = 0)
        : values_(static_cast<T*>(
              n > 0 ? ::operator new (n * sizeof(T), std::align_val_t{alignof(T)}) : nullptr))
    {
    }

    T& operator[](std::size_t i) { return values_.get()[i]; }
    const T& operator[](std::size_t i) const { return values_.get()[i]; }
    T* data() { return values_.get(); }
    void swap(RawArray& other) noexcept { values_.swap(other.values_); }

private:
    struct Free
    {
        void operator()(T* values) const
        {
            ::operator delete (values, std::align_val_t{alignof(T)});
        }
    };
    std::unique_ptr<T, Free> values_;
};

} // namespace fppg
