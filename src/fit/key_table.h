#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Three cell numbers in one word; cells 2^21 apart share a key, which costs time, not correctness.
inline std::uint64_t cell_key(std::int64_t i, std::int64_t j, std::int64_t k)
{
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(i) & mask) << 42 |
           (static_cast<std::uint64_t>(j) & mask) << 21 | (static_cast<std::uint64_t>(k) & mask);
}

/// Numbers the keys that it is given in the order of their coming: an open-addressed table.
class KeyTable
{
public:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    void clear()
    {
        slots_.assign(64, {0, none});
        shift_ = 58;
        count_ = 0;
    }
    std::uint32_t size() const { return count_; }

    std::uint32_t find(std::uint64_t key) const
    {
        for (std::size_t s = first_slot(key);; s = (s + 1) & (slots_.size() - 1))
        {
            if (slots_[s].value == none || slots_[s].key == key) return slots_[s].value;
        }
    }

    std::uint32_t find_or_add(std::uint64_t key)
    {
        if (2 * (count_ + std::size_t{1}) > slots_.size()) grow();
        std::size_t s = first_slot(key);
        while (slots_[s].value != none && slots_[s].key != key) s = (s + 1) & (slots_.size() - 1);
        if (slots_[s].value == none) slots_[s] = {key, count_++};
        return slots_[s].value;
    }

private:
    struct Slot
    {
        std::uint64_t key;
        std::uint32_t value;
    };

    std::size_t first_slot(std::uint64_t key) const
    {
        return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> shift_);
    }

    void grow()
    {
        std::vector<Slot> old(2 * slots_.size(), {0, none});
        old.swap(slots_);
        --shift_;
        for (const Slot& slot : old)
        {
            if (slot.value == none) continue;
            std::size_t s = first_slot(slot.key);
            while (slots_[s].value != none) s = (s + 1) & (slots_.size() - 1);
            slots_[s] = slot;
        }
    }

    std::vector<Slot> slots_ = std::vector<Slot>(64, {0, none});
    int shift_ = 58; ///< 64 less the binary logarithm of the number of slots
    std::uint32_t count_ = 0;
};

} // namespace fppg
