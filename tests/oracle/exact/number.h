// SPDX-License-Identifier: MIT
// Numbers of the exact oracle: dyadic numbers and their quotients over GMP integers, and intervals
// of doubles that tell most signs first.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <gmpxx.h>
#include <limits>

namespace boxtree::oracle {

/// mantissa * 2^exponent. Every finite double is one; sums and products are exact and need no
/// common divisors, unlike mpq_class.
class Dyadic {
 public:
  Dyadic() = default;
  /// Precondition: x is finite.
  Dyadic(double x) {  // NOLINT(google-explicit-constructor): every double is a dyadic number
    if (x == 0) return;
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    auto bits = static_cast<long>(std::ldexp(fraction, 53));
    const int zeros = __builtin_ctzl(static_cast<unsigned long>(bits));
    bits >>= zeros;  // exact: these bits are zero
    mantissa_ = bits;
    exponent_ = exponent - 53 + zeros;
  }

  [[nodiscard]] int sign() const { return sgn(mantissa_); }
  [[nodiscard]] Dyadic times_power_of_two(long exponent) const {
    Dyadic result = *this;
    if (result.sign() != 0) result.exponent_ += exponent;
    return result;
  }
  /// To 320 bits.
  [[nodiscard]] mpf_class to_mpf() const {
    mpf_class value(mantissa_, 320);
    if (exponent_ >= 0) {
      mpf_mul_2exp(value.get_mpf_t(), value.get_mpf_t(), static_cast<unsigned long>(exponent_));
    } else {
      mpf_div_2exp(value.get_mpf_t(), value.get_mpf_t(), static_cast<unsigned long>(-exponent_));
    }
    return value;
  }
  /// The same number as a double, or NaN where no double is that number.
  [[nodiscard]] double as_double() const {
    if (sign() == 0) return 0;
    if (mpz_sizeinbase(mantissa_.get_mpz_t(), 2) > 1100) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const double value = std::ldexp(mantissa_.get_d(), static_cast<int>(exponent_));
    const bool is_same = std::isfinite(value) && (Dyadic(value) - *this).sign() == 0;
    return is_same ? value : std::numeric_limits<double>::quiet_NaN();
  }

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return sum(a, b, false); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return sum(a, b, true); }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    Dyadic result;
    result.mantissa_ = a.mantissa_ * b.mantissa_;
    if (result.sign() != 0) result.exponent_ = a.exponent_ + b.exponent_;
    return result;
  }
  Dyadic operator-() const {
    Dyadic result = *this;
    result.mantissa_ = -result.mantissa_;
    return result;
  }

 private:
  static Dyadic sum(const Dyadic& a, const Dyadic& b, bool negate) {
    if (b.sign() == 0) return a;
    if (a.sign() == 0) return negate ? -b : b;
    Dyadic result;
    result.exponent_ = std::min(a.exponent_, b.exponent_);
    const Dyadic& high = a.exponent_ > b.exponent_ ? a : b;
    const Dyadic& low = a.exponent_ > b.exponent_ ? b : a;
    mpz_mul_2exp(result.mantissa_.get_mpz_t(), high.mantissa_.get_mpz_t(),
                 static_cast<unsigned long>(high.exponent_ - low.exponent_));
    if (!negate) {
      result.mantissa_ += low.mantissa_;
    } else if (&high == &a) {
      result.mantissa_ -= low.mantissa_;
    } else {
      result.mantissa_ = low.mantissa_ - result.mantissa_;
    }
    if (result.sign() == 0) result.exponent_ = 0;
    return result;
  }

  mpz_class mantissa_ = 0;
  long exponent_ = 0;
};

inline int sign_of(const Dyadic& x) {
  return x.sign();
}
inline bool operator<(const Dyadic& a, const Dyadic& b) {
  return (a - b).sign() < 0;
}

/// A quotient of dyadic numbers; the denominator is positive.
struct Quotient {
  Dyadic numerator;
  Dyadic denominator = 1.0;

  [[nodiscard]] int sign() const { return numerator.sign(); }
  [[nodiscard]] mpf_class to_mpf() const {
    return mpf_class(numerator.to_mpf() / denominator.to_mpf(), 320);
  }
  friend bool operator<(const Quotient& a, const Quotient& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
  }
};

/// Root of a quotient that is not negative, to some 300 bits.
inline mpf_class root_of(const Quotient& square) {
  return mpf_class(sqrt(square.to_mpf()), 320);
}

/// Thrown where an interval does not tell a sign.
struct Uncertain {};

/// An interval of doubles that holds the exact result; ends are moved outward by at least what
/// rounding to nearest can be off.
class Interval {
 public:
  Interval() = default;
  Interval(double x) : low_(x), high_(x) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] int sign() const {
    if (low_ > 0) return 1;
    if (high_ < 0) return -1;
    if (low_ == 0 && high_ == 0) return 0;
    throw Uncertain{};
  }

  friend Interval operator+(const Interval& a, const Interval& b) {
    return sum(a, b.low_, b.high_);
  }
  friend Interval operator-(const Interval& a, const Interval& b) {
    return sum(a, -b.high_, -b.low_);
  }
  friend Interval operator*(const Interval& a, const Interval& b) {
    if (a.is_zero() || b.is_zero()) return {};
    const std::array<double, 4> products = {a.low_ * b.low_, a.low_ * b.high_, a.high_ * b.low_,
                                            a.high_ * b.high_};
    for (const double p : products) {
      if (!std::isfinite(p)) return anything();
    }
    const auto [low, high] = std::minmax_element(products.begin(), products.end());
    return widened(*low, *high);
  }

 private:
  [[nodiscard]] bool is_zero() const { return low_ == 0 && high_ == 0; }
  static Interval anything() {
    Interval all;
    all.low_ = -std::numeric_limits<double>::infinity();
    all.high_ = std::numeric_limits<double>::infinity();
    return all;
  }
  // x - |x| 2^-52 rounds to at most the double below x; the smallest double serves subnormal x.
  static double slack(double x) {
    return std::abs(x) * std::numeric_limits<double>::epsilon() +
           std::numeric_limits<double>::denorm_min();
  }
  static Interval widened(double low, double high) {
    Interval result;
    result.low_ = low - slack(low);
    result.high_ = high + slack(high);
    if (!std::isfinite(result.low_) || !std::isfinite(result.high_)) return anything();
    return result;
  }
  static bool is_exact_sum(double a, double b, double s) {
    const double bb = s - a;  // TwoSum (Knuth)
    return (a - (s - bb)) + (b - bb) == 0;
  }
  static Interval sum(const Interval& a, double low, double high) {
    const double l = a.low_ + low, h = a.high_ + high;
    if (a.low_ == a.high_ && low == high && std::isfinite(l) && is_exact_sum(a.low_, low, l)) {
      return {l};  // differences of f32 numbers, mostly
    }
    return widened(l, h);
  }

  double low_ = 0;
  double high_ = 0;
};

inline int sign_of(const Interval& x) {
  return x.sign();
}

}  // namespace boxtree::oracle
