// SPDX-License-Identifier: Apache-2.0
// Numbers of the mechanics: a double, or `Lanes`, the doubles of neighbouring nodes, one per lane.
//
// Every formula is a template over the number type, for the head (a double) and for the nodes along the body (lanes).
// Arithmetic is lane by lane; a double combined with lanes applies to all of them.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <new>
#include <numbers>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace eel_core {

#if defined(__AVX512F__)
inline constexpr std::size_t width = 8;  // lanes: doubles in one register
#elif defined(__AVX__)
inline constexpr std::size_t width = 4;
#else
inline constexpr std::size_t width = 2;
#endif
inline constexpr std::size_t filled =
    8;  // the number of nodes is a multiple of this, so that all machines use the same grid

class Mask;

class Lanes {
  public:
    using Native = double __attribute__((vector_size(width * sizeof(double))));
    using Bits = std::int64_t __attribute__((vector_size(width * sizeof(double))));

    Lanes() = default;
    Lanes(double value) : native_(value - Native{}) {}  // NOLINT(google-explicit-constructor): for all lanes
    explicit Lanes(Native native) : native_(native) {}

    // From and to neighbouring doubles, which need not be aligned.
    static Lanes load(const double* from) { return Lanes(*reinterpret_cast<const Neighbours*>(from)); }
    void store(double* to) const { *reinterpret_cast<Neighbours*>(to) = native_; }

    double operator[](std::size_t lane) const { return native_[lane]; }
    Native native() const { return native_; }

    Lanes operator-() const { return Lanes(-native_); }
    Lanes& operator+=(Lanes other) { return native_ += other.native_, *this; }
    Lanes& operator-=(Lanes other) { return native_ -= other.native_, *this; }
    friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.native_ + b.native_); }
    friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.native_ - b.native_); }
    friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.native_ * b.native_); }
    friend Lanes operator/(Lanes a, Lanes b) { return Lanes(a.native_ / b.native_); }
    friend Mask operator<(Lanes a, Lanes b);
    friend Mask operator>(Lanes a, Lanes b);
    friend Mask operator>=(Lanes a, Lanes b);

  private:
    // The same type in memory, unaligned. Unlike memcpy it tells GCC that a store changes only doubles.
    using Neighbours __attribute__((aligned(alignof(double)))) = Native;

    Native native_;
};

// For each lane, whether a condition holds.
class Mask {
  public:
#if defined(__AVX512F__)
    using Native = __mmask8;
#else
    using Native = Lanes::Bits;
#endif
    explicit Mask(Native native) : native_(native) {}

    // The bits of a whole number; the first lane is the lowest.
    unsigned bits() const
    {
#if defined(__AVX512F__)
        return native_;
#elif defined(__AVX__)
        return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(native_)));
#else
        unsigned result = 0;
        for (std::size_t lane = 0; lane < width; ++lane) result |= native_[lane] != 0 ? 1u << lane : 0u;
        return result;
#endif
    }
    bool any() const { return bits() != 0; }

    // The first `count` lanes.
    static Mask below(std::size_t count)
    {
#if defined(__AVX512F__)
        return Mask(static_cast<Native>(count < width ? (1u << count) - 1u : ~0u));
#else
        Native number;
        for (std::size_t lane = 0; lane < width; ++lane) number[lane] = static_cast<std::int64_t>(lane);
        return Mask(number < static_cast<std::int64_t>(count));
#endif
    }

    friend Lanes select(Mask mask, Lanes yes, Lanes no);

  private:
    Native native_;
};

#if defined(__AVX512F__)
inline Mask operator<(Lanes a, Lanes b) { return Mask(_mm512_cmp_pd_mask(a.native_, b.native_, _CMP_LT_OQ)); }
inline Mask operator>(Lanes a, Lanes b) { return Mask(_mm512_cmp_pd_mask(a.native_, b.native_, _CMP_GT_OQ)); }
inline Mask operator>=(Lanes a, Lanes b) { return Mask(_mm512_cmp_pd_mask(a.native_, b.native_, _CMP_GE_OQ)); }
#else
inline Mask operator<(Lanes a, Lanes b) { return Mask(a.native_ < b.native_); }
inline Mask operator>(Lanes a, Lanes b) { return Mask(a.native_ > b.native_); }
inline Mask operator>=(Lanes a, Lanes b) { return Mask(a.native_ >= b.native_); }
#endif

// Allocates doubles so that a block of lanes lies within one cache line.
template <class T>
struct Aligned {
    using value_type = T;
    static constexpr std::align_val_t line{64};

    Aligned() = default;
    template <class B>
    Aligned(const Aligned<B>&)
    {
    }  // NOLINT(google-explicit-constructor): as in every allocator
    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line)); }
    void deallocate(T* memory, std::size_t) { ::operator delete(memory, line); }
    friend bool operator==(const Aligned&, const Aligned&) { return true; }
};

template <class T>
concept Number = std::same_as<T, double> || std::same_as<T, Lanes>;

// -- choices

inline Lanes select(Mask mask, Lanes yes, Lanes no)
{
#if defined(__AVX512F__)
    return Lanes(_mm512_mask_blend_pd(mask.native_, no.native(), yes.native()));
#else
    return Lanes(mask.native_ ? yes.native() : no.native());
#endif
}
inline bool any(bool condition) { return condition; }
inline bool any(Mask mask) { return mask.any(); }
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

// The magnitude of `value` with the sign of `sign`.
inline double with_sign_of(double value, double sign) { return std::copysign(value, sign); }
inline Lanes with_sign_of(Lanes value, Lanes sign)
{
    const Lanes::Bits negative = std::bit_cast<Lanes::Bits>(Lanes(-0.0).native());
    const auto v = std::bit_cast<Lanes::Bits>(value.native()), s = std::bit_cast<Lanes::Bits>(sign.native());
    return Lanes(std::bit_cast<Lanes::Native>((v & ~negative) | (s & negative)));
}

// -- functions

// `of` applied to each lane. Compilers vectorise it if the processor allows.
inline Lanes lane_by_lane(Lanes value, const auto& of)
{
    Lanes::Native result;
    for (std::size_t lane = 0; lane < width; ++lane) result[lane] = of(value[lane]);
    return Lanes(result);
}

inline double abs(double value) { return std::abs(value); }
inline Lanes abs(Lanes value) { return with_sign_of(value, Lanes(1.0)); }

inline double sqrt(double value) { return std::sqrt(value); }
inline Lanes sqrt(Lanes value)
{
    return lane_by_lane(value, [](double each) { return std::sqrt(each); });
}

inline double round_down(double value) { return std::floor(value); }
inline Lanes round_down(Lanes value)
{
    return lane_by_lane(value, [](double each) { return std::floor(each); });
}

// Sum of the lanes: the upper half is added to the lower half, until two are left.
inline double total(double value) { return value; }
template <class Vector, std::size_t... Low>
double sum_of_halves(Vector lanes, std::index_sequence<Low...>)
{
    constexpr std::size_t half = sizeof...(Low);
    if constexpr (half == 1)
        return lanes[0] + lanes[1];
    else
        return sum_of_halves(
            __builtin_shufflevector(lanes, lanes, Low...) + __builtin_shufflevector(lanes, lanes, (Low + half)...),
            std::make_index_sequence<half / 2>());
}
inline double total(Lanes value) { return sum_of_halves(value.native(), std::make_index_sequence<width / 2>()); }

inline double last(Lanes value) { return value[width - 1]; }

// The lanes shifted by `Steps` towards the last; the first lanes are the `filling`.
template <std::size_t Steps>
Lanes moved(Lanes value, double filling)
{
    return [&]<std::size_t... Lane>(std::index_sequence<Lane...>) {
        return Lanes(
            __builtin_shufflevector(value.native(), Lanes(filling).native(), (Lane < Steps ? width : Lane - Steps)...));
    }(std::make_index_sequence<width>());
}

// The smooth ramp f_r of eq. (64) at a fraction 0 to 1.
inline double smooth_ramp(double part)
{
    constexpr double turn = 2.0 * std::numbers::pi;
    return part - std::sin(turn * part) / turn;
}

// -- functions exact to round-off, without branches

// sin(x)/x and cos(x) from z = x^2 up to 0.62, that is x up to pi/4: Taylor's series.
template <Number T>
std::array<T, 2> sine_and_cosine_series(T z)
{
    T s = T(-1.0 / 1307674368000.0) * z + 1.0 / 6227020800.0;
    T c = (T(1.0 / 20922789888000.0) * z - 1.0 / 87178291200.0) * z + 1.0 / 479001600.0;
    s = s * z - 1.0 / 39916800.0, c = c * z - 1.0 / 3628800.0;
    s = s * z + 1.0 / 362880.0, c = c * z + 1.0 / 40320.0;
    s = s * z - 1.0 / 5040.0, c = c * z - 1.0 / 720.0;
    s = s * z + 1.0 / 120.0, c = c * z + 1.0 / 24.0;
    s = s * z - 1.0 / 6.0, c = c * z - 0.5;
    return {1.0 + z * s, 1.0 + z * c};
}

// Sine and cosine of an angle [rad] below 1e5.
template <Number T>
std::array<T, 2> sine_and_cosine(T angle)
{
    constexpr double quarter_turn = 1.5707963267341256, its_rest = 6.077100506506192e-11;  // pi/2 in two parts
    const T quarters = round_down(angle * 0.6366197723675814 + 0.5);
    const T x = (angle - quarters * quarter_turn) - quarters * its_rest;
    auto [s, c] = sine_and_cosine_series(x * x);
    s = s * x;
    const T odd = quarters - 2.0 * round_down(0.5 * quarters);  // 1: a quarter turn to go
    const T sign = 1.0 - 2.0 * (round_down(0.5 * quarters) - 2.0 * round_down(0.25 * quarters));  // -1: half a turn
    return {sign * (s + odd * (c - s)), sign * (c - odd * (c + s))};
}

// exp(x): 2^n exp(rest), with Taylor's series of the rest, at most ln(2)/2. Below -700 the result is exp(-700).
template <Number T>
T exponential(T x)
{
    constexpr double ln2 = 0.69314718036912381649, its_rest = 1.90821492927058770002e-10;  // in two parts
    constexpr double shift = 6755399441055744.0;  // 1.5 * 2^52: added to a whole number, its last bits are that number
    const T bounded = select(x < T(-700.0), T(-700.0), x);
    const T n = round_down(bounded * 1.4426950408889634 + 0.5);
    const T r = (bounded - n * ln2) - n * its_rest;
    T sum(1.0 / 6227020800.0);
    for (const double coefficient :
         {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0,
          1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0})
        sum = sum * r + coefficient;
    if constexpr (std::same_as<T, double>) {
        const auto bits = std::bit_cast<std::uint64_t>(n + shift) << 52u;
        return sum * std::bit_cast<double>(bits + std::bit_cast<std::uint64_t>(1.0));
    } else {
        const auto bits = std::bit_cast<Lanes::Bits>((n + shift).native()) << 52;
        return sum * Lanes(std::bit_cast<Lanes::Native>(bits + std::bit_cast<Lanes::Bits>(Lanes(1.0).native())));
    }
}

// x^(-1/5) of positive numbers: a fifth of the exponent, good to 4 per cent, then two steps of order 4 with the
// binomial series of (1 - e)^(-1/5), e = 1 - x y^5.
template <Number T>
T inverse_fifth_root(T x)
{
    constexpr double offset = 1.2 * (1023.0 - 0.045) * 4503599627370496.0;  // of the exponent's bits
    const auto guess = [](double each) {
        const auto number = static_cast<double>(std::bit_cast<std::int64_t>(each));
        return std::bit_cast<double>(static_cast<std::int64_t>(offset - 0.2 * number));
    };
    T y;
    if constexpr (std::same_as<T, double>)
        y = guess(x);
    else
        y = lane_by_lane(x, guess);
    for (int step = 0; step < 2; ++step) {
        const T square = y * y, e = 1.0 - x * (square * square * y);
        y += y * e * (0.2 + e * (0.12 + e * 0.088));
    }
    return y;
}

}  // namespace eel_core
