#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fppg
{

/// Keeps the first `most` of all items added, in the order of `Less` (total, no two equal), in room
/// for twice as many; what is kept does not depend on the order in which they come.
template <typename T, typename Less>
class FirstFew
{
public:
    explicit FirstFew(std::size_t most, Less less = {}) : most_(most), less_(less) {}

    void add(const T& item)
    {
        if (most_ == 0) return;
        items_.push_back(item);
        if (items_.size() >= 2 * most_ + 16) shrink();
    }
    void add(const FirstFew& other)
    {
        for (const T& item : other.items_) add(item);
    }
    std::vector<T> sorted() const
    {
        std::vector<T> out = items_;
        std::sort(out.begin(), out.end(), less_);
        if (out.size() > most_) out.resize(most_);
        return out;
    }

private:
    std::size_t most_;
    Less less_;
    std::vector<T> items_;

    void shrink()
    {
        std::nth_element(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(most_),
                         items_.end(), less_);
        items_.resize(most_);
    }
};

} // namespace fppg
