#pragma once

#include "fppg/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace fppg
{

/// Adds up numbers from 0 to 3.9 as whole multiples of 2^-30, so that a sum has the same bits in
/// any order. Up to 2^32 numbers.
class ExactStatistics
{
public:
    void add(double value, const HistogramRange& range)
    {
        const double clamped = std::clamp(value, 0.0, 3.9);
        const auto quanta = static_cast<std::uint64_t>(std::llround(clamped * quanta_of_one));
        ++count_;
        sum_ += quanta;
        squares_ += static_cast<Wide>(quanta) * quanta;
        least_ = std::min(least_, quanta);
        largest_ = std::max(largest_, quanta);
        const double share = (clamped - range.begin) / (range.end - range.begin);
        const double bin =
            std::clamp(std::floor(share * Statistics::bins), 0.0, Statistics::bins - 1.0);
        ++histogram_[static_cast<std::size_t>(bin)];
    }

    void add(const ExactStatistics& other)
    {
        count_ += other.count_;
        sum_ += other.sum_;
        squares_ += other.squares_;
        least_ = std::min(least_, other.least_);
        largest_ = std::max(largest_, other.largest_);
        for (std::size_t b = 0; b < Statistics::bins; ++b) histogram_[b] += other.histogram_[b];
    }

    Statistics statistics() const
    {
        Statistics out;
        if (count_ == 0) return out;
        out.count = count_;
        const auto n = static_cast<double>(count_);
        out.mean = static_cast<double>(sum_) / n / quanta_of_one;
        const Wide variance = static_cast<Wide>(count_) * squares_ - static_cast<Wide>(sum_) * sum_;
        out.deviation = std::sqrt(static_cast<double>(variance)) / n / quanta_of_one;
        out.least = static_cast<double>(least_) / quanta_of_one;
        out.largest = static_cast<double>(largest_) / quanta_of_one;
        out.histogram = histogram_;
        return out;
    }

private:
    __extension__ using Wide = unsigned __int128;
    static constexpr double quanta_of_one = 1073741824.0;

    std::uint64_t count_ = 0;
    std::uint64_t sum_ = 0; ///< below 2^64 for 2^32 numbers
    Wide squares_ = 0;
    std::uint64_t least_ = UINT64_MAX;
    std::uint64_t largest_ = 0;
    std::array<std::uint64_t, Statistics::bins> histogram_{};
};

} // namespace fppg
