// SPDX-License-Identifier: MIT
// In the amalgamation, in place of Eigen: the few of its types and operations that the runtime
// uses, by the names that they have there, evaluated at once. Each operation is one of a
// coefficient, so numbers are the same to the bit; sums, whose order Eigen chooses, are
// primitive/vector3.h's.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace Eigen {

using Index = std::ptrdiff_t;

enum Option { ColMajor = 0, DontAlign = 2 };
enum TransformMode { Affine = 1 };

template <class T, int kRows, int kColumns, int kOptions = ColMajor>
class Matrix;

/// Coefficients that are compared or added to, one by one.
template <class T, int kRows, int kColumns>
class Array {
 public:
  Array() = default;
  [[nodiscard]] bool all() const {
    for (const T& x : at) {
      if (!x) return false;
    }
    return true;
  }
  template <class Test>
  [[nodiscard]] Array<bool, kRows, kColumns> where(const Test& test) const {
    Array<bool, kRows, kColumns> out;
    for (std::size_t i = 0; i < at.size(); ++i) out.at[i] = test(i);
    return out;
  }
  friend auto operator<=(const Array& a, const T& b) {
    return a.where([&](std::size_t i) { return a.at[i] <= b; });
  }
  friend auto operator<=(const Array& a, const Array& b) {
    return a.where([&](std::size_t i) { return a.at[i] <= b.at[i]; });
  }
  friend auto operator>=(const Array& a, const Array& b) {
    return a.where([&](std::size_t i) { return a.at[i] >= b.at[i]; });
  }
  friend Array operator+(Array a, const T& b) {
    for (T& x : a.at) x += b;
    return a;
  }

  std::array<T, static_cast<std::size_t>(kRows* kColumns)> at;
};

/// A row or column of a matrix that is written to.
template <class M, int kRows, int kColumns>
class Part {
 public:
  using Value = Matrix<typename M::Scalar, kRows, kColumns>;
  constexpr Part(M& matrix, Index fixed) : matrix_(matrix), fixed_(fixed) {}
  Part(const Part&) = default;

  constexpr operator Value() const {
    Value out;
    for (Index i = 0; i < kRows * kColumns; ++i) out[i] = at(i);
    return out;
  }
  template <int kOptions>
  constexpr operator Matrix<typename M::Scalar, kRows, kColumns, kOptions>() const
      requires(kOptions != ColMajor) {
    return Value(*this);
  }
  constexpr Part& operator=(const Value& value) {
    for (Index i = 0; i < kRows * kColumns; ++i) at(i) = value[i];
    return *this;
  }
  constexpr Part& operator=(const Part& other) { return *this = Value(other); }
  constexpr Part& operator*=(typename M::Scalar factor) { return *this = Value(*this) * factor; }
  constexpr Part& operator/=(typename M::Scalar divisor) { return *this = Value(*this) / divisor; }
  constexpr typename M::Scalar& operator[](Index i) const { return at(i); }

 private:
  constexpr typename M::Scalar& at(Index i) const {
    if constexpr (kRows == 1) {
      return matrix_(fixed_, i);
    } else {
      return matrix_(i, fixed_);
    }
  }

  M& matrix_;
  Index fixed_;
};

/// A matrix of fixed size, column after column.
template <class T, int kRows, int kColumns, int kOptions>
class Matrix {
  static constexpr Index kSize = Index{kRows} * kColumns;
  static constexpr bool kIsVector = kRows == 1 || kColumns == 1;

 public:
  using Scalar = T;
  static constexpr int RowsAtCompileTime = kRows;
  static constexpr int ColsAtCompileTime = kColumns;

  Matrix() = default;
  /// Coefficients of a vector.
  template <class... Rest>
  constexpr Matrix(const T& first, const Rest&... rest) requires(kIsVector &&
                                                                 1 + sizeof...(Rest) == kSize &&
                                                                 kSize > 1)
      : at_{first, static_cast<T>(rest)...} {}
  /// Of another layout.
  template <int kOther>
  constexpr Matrix(const Matrix<T, kRows, kColumns, kOther>& other) requires(kOther != kOptions) {
    for (Index i = 0; i < kSize; ++i) at_[static_cast<std::size_t>(i)] = other.data()[i];
  }

  static constexpr Matrix Constant(const T& value) {
    Matrix out;
    out.at_.fill(value);
    return out;
  }
  static constexpr Matrix Zero() { return Constant(T(0)); }
  static constexpr Matrix Identity() {
    Matrix out = Zero();
    for (Index i = 0; i < (kRows < kColumns ? kRows : kColumns); ++i) out(i, i) = T(1);
    return out;
  }
  static constexpr Matrix Unit(Index i) {
    Matrix out = Zero();
    out[i] = T(1);
    return out;
  }
  static constexpr Matrix UnitX() { return Unit(0); }
  static constexpr Matrix UnitY() { return Unit(1); }
  static constexpr Matrix UnitZ() { return Unit(2); }

  constexpr T& operator()(Index row, Index column) { return at_[place(row, column)]; }
  constexpr const T& operator()(Index row, Index column) const { return at_[place(row, column)]; }
  constexpr T& operator[](Index i) { return at_[static_cast<std::size_t>(i)]; }
  constexpr const T& operator[](Index i) const { return at_[static_cast<std::size_t>(i)]; }
  constexpr T& operator()(Index i) { return (*this)[i]; }
  constexpr const T& operator()(Index i) const { return (*this)[i]; }
  constexpr T& x() { return at_[0]; }
  constexpr const T& x() const { return at_[0]; }
  constexpr T& y() { return at_[1]; }
  constexpr const T& y() const { return at_[1]; }
  constexpr T& z() { return at_[2]; }
  constexpr const T& z() const { return at_[2]; }
  constexpr T& w() { return at_[3]; }
  constexpr const T& w() const { return at_[3]; }
  constexpr T* data() { return at_.data(); }
  constexpr const T* data() const { return at_.data(); }
  constexpr auto begin() const { return at_.begin(); }
  constexpr auto end() const { return at_.end(); }
  static constexpr Index size() { return kSize; }

  constexpr auto col(Index i) { return Part<Matrix, kRows, 1>(*this, i); }
  constexpr Matrix<T, kRows, 1> col(Index i) const {
    Matrix<T, kRows, 1> out;
    for (Index row = 0; row < kRows; ++row) out[row] = (*this)(row, i);
    return out;
  }
  constexpr auto row(Index i) { return Part<Matrix, 1, kColumns>(*this, i); }
  constexpr Matrix<T, 1, kColumns> row(Index i) const {
    Matrix<T, 1, kColumns> out;
    for (Index column = 0; column < kColumns; ++column) out[column] = (*this)(i, column);
    return out;
  }
  template <int kCount>
  [[nodiscard]] constexpr Matrix<T, kCount, 1> head() const {
    Matrix<T, kCount, 1> out;
    for (Index i = 0; i < kCount; ++i) out[i] = (*this)[i];
    return out;
  }
  [[nodiscard]] constexpr Matrix<T, kColumns, kRows> transpose() const {
    Matrix<T, kColumns, kRows> out;
    for (Index row = 0; row < kRows; ++row) {
      for (Index column = 0; column < kColumns; ++column) out(column, row) = (*this)(row, column);
    }
    return out;
  }
  constexpr Matrix& setZero() { return *this = Zero(); }
  constexpr Matrix& setConstant(const T& value) { return *this = Constant(value); }

  /// Fills columns, or a vector's coefficients, in order: `matrix << a, b, c`.
  class Filler {
   public:
    constexpr Filler(Matrix& matrix) : matrix_(matrix) {}
    constexpr Filler& operator,(const T& value) {
      matrix_.at_[next_++] = value;
      return *this;
    }
    template <int kCount>
    constexpr Filler& operator,(const Matrix<T, kCount, 1>& values) {
      for (const T& value : values) *this, value;
      return *this;
    }

   private:
    Matrix& matrix_;
    std::size_t next_ = 0;
  };
  template <class First>
  constexpr Filler operator<<(const First& first) {
    Filler filler(*this);
    filler, first;
    return filler;
  }

  [[nodiscard]] constexpr Matrix cwiseAbs() const {
    return each([](const T& x) { return std::abs(x); });
  }
  [[nodiscard]] constexpr Matrix cwiseMin(const Matrix& other) const {
    return each(other, [](const T& a, const T& b) { return b < a ? b : a; });
  }
  [[nodiscard]] constexpr Matrix cwiseMax(const Matrix& other) const {
    return each(other, [](const T& a, const T& b) { return a < b ? b : a; });
  }
  [[nodiscard]] constexpr Matrix cwiseProduct(const Matrix& other) const {
    return each(other, [](const T& a, const T& b) { return a * b; });
  }
  [[nodiscard]] constexpr Matrix cwiseMin(const T& other) const {
    return each([&](const T& x) { return other < x ? other : x; });
  }
  [[nodiscard]] constexpr Matrix cwiseMax(const T& other) const {
    return each([&](const T& x) { return x < other ? other : x; });
  }
  [[nodiscard]] constexpr T maxCoeff() const {
    Index place = 0;
    return maxCoeff(&place);
  }
  [[nodiscard]] constexpr T minCoeff() const {
    Index place = 0;
    return minCoeff(&place);
  }
  /// Also the first place where it is.
  constexpr T maxCoeff(Index* place) const {
    *place = 0;
    for (Index i = 1; i < kSize; ++i) {
      if ((*this)[*place] < (*this)[i]) *place = i;
    }
    return (*this)[*place];
  }
  /// The same.
  constexpr T minCoeff(Index* place) const {
    *place = 0;
    for (Index i = 1; i < kSize; ++i) {
      if ((*this)[i] < (*this)[*place]) *place = i;
    }
    return (*this)[*place];
  }
  [[nodiscard]] constexpr Matrix cross(const Matrix& b) const {
    const Matrix& a = *this;
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  /// Whether no coefficient is larger than `precision`; NaN is.
  [[nodiscard]] constexpr bool isZero(const T& precision = T(1e-12)) const {
    for (const T& x : at_) {
      if (!(std::abs(x) <= precision)) return false;
    }
    return true;
  }
  [[nodiscard]] bool allFinite() const {
    for (const T& x : at_) {
      if (!std::isfinite(x)) return false;
    }
    return true;
  }
  [[nodiscard]] constexpr Array<T, kRows, kColumns> array() const {
    Array<T, kRows, kColumns> out;
    out.at = at_;
    return out;
  }
  constexpr Matrix(const Array<T, kRows, kColumns>& array) : at_(array.at) {}

  constexpr Matrix& operator+=(const Matrix& b) { return *this = *this + b; }
  constexpr Matrix& operator-=(const Matrix& b) { return *this = *this - b; }
  constexpr Matrix& operator*=(const T& b) { return *this = *this * b; }
  constexpr Matrix& operator/=(const T& b) { return *this = *this / b; }
  friend constexpr Matrix operator-(const Matrix& a) {
    return a.each([](const T& x) { return -x; });
  }
  friend constexpr Matrix operator+(const Matrix& a, const Matrix& b) {
    return a.each(b, [](const T& x, const T& y) { return x + y; });
  }
  friend constexpr Matrix operator-(const Matrix& a, const Matrix& b) {
    return a.each(b, [](const T& x, const T& y) { return x - y; });
  }
  friend constexpr Matrix operator*(const Matrix& a, const T& b) {
    return a.each([&](const T& x) { return x * b; });
  }
  friend constexpr Matrix operator*(const T& a, const Matrix& b) {
    return b.each([&](const T& x) { return a * x; });
  }
  friend constexpr Matrix operator/(const Matrix& a, const T& b) {
    return a.each([&](const T& x) { return x / b; });
  }
  friend constexpr bool operator==(const Matrix& a, const Matrix& b) {
    for (Index i = 0; i < kSize; ++i) {
      if (!(a[i] == b[i])) return false;
    }
    return true;
  }
  friend constexpr bool operator!=(const Matrix& a, const Matrix& b) { return !(a == b); }

 private:
  static constexpr std::size_t place(Index row, Index column) {
    return static_cast<std::size_t>(column * kRows + row);
  }
  template <class F>
  constexpr Matrix each(const F& f) const {
    Matrix out;
    for (Index i = 0; i < kSize; ++i) out[i] = f((*this)[i]);
    return out;
  }
  template <class F>
  constexpr Matrix each(const Matrix& other, const F& f) const {
    Matrix out;
    for (Index i = 0; i < kSize; ++i) out[i] = f((*this)[i], other[i]);
    return out;
  }

  std::array<T, static_cast<std::size_t>(kSize)> at_;
};

using Vector2d = Matrix<double, 2, 1>;
using Vector3d = Matrix<double, 3, 1>;
using Matrix3d = Matrix<double, 3, 3>;

/// A box along the axes; empty where a minimum is above its maximum.
class AlignedBox3d {
 public:
  AlignedBox3d()
      : min_(Vector3d::Constant(std::numeric_limits<double>::max())),
        max_(Vector3d::Constant(std::numeric_limits<double>::lowest())) {}
  AlignedBox3d(const Vector3d& min, const Vector3d& max) : min_(min), max_(max) {}
  [[nodiscard]] const Vector3d& min() const { return min_; }
  [[nodiscard]] const Vector3d& max() const { return max_; }
  [[nodiscard]] bool isEmpty() const { return !(min_.array() <= max_.array()).all(); }

 private:
  Vector3d min_, max_;
};

/// A rotation: x, y, z, w.
template <class T, int kOptions = ColMajor>
class Quaternion {
 public:
  Quaternion() = default;
  Quaternion(const T& w, const T& x, const T& y, const T& z) : coeffs_(x, y, z, w) {}
  [[nodiscard]] const Matrix<T, 4, 1>& coeffs() const { return coeffs_; }
  [[nodiscard]] Matrix<T, 3, 1> vec() const { return coeffs_.template head<3>(); }
  [[nodiscard]] const T& x() const { return coeffs_[0]; }
  [[nodiscard]] const T& y() const { return coeffs_[1]; }
  [[nodiscard]] const T& z() const { return coeffs_[2]; }
  [[nodiscard]] const T& w() const { return coeffs_[3]; }

 private:
  Matrix<T, 4, 1> coeffs_;
};

/// An affine map: four columns of four, the last row of which is 0 0 0 1.
template <class T, int kDimensions, int kMode, int kOptions = ColMajor>
class Transform {
 public:
  static Transform Identity() {
    Transform out;
    out.matrix_ = Matrix<T, 4, 4>::Identity();
    return out;
  }

  // The part of the map that is linear, as what is read and, column by column, written.
  class Linear {
   public:
    explicit Linear(Matrix<T, 4, 4>& matrix) : matrix_(matrix) {}
    operator Matrix<T, 3, 3>() const { return Transform::linear_of(matrix_); }
    class Column {
     public:
      Column(Matrix<T, 4, 4>& matrix, Index column) : matrix_(matrix), column_(column) {}
      Column& operator=(const Matrix<T, 3, 1>& value) {
        for (Index i = 0; i < 3; ++i) matrix_(i, column_) = value[i];
        return *this;
      }

     private:
      Matrix<T, 4, 4>& matrix_;
      Index column_;
    };
    Column col(Index column) { return Column(matrix_, column); }
    Linear& operator=(const Matrix<T, 3, 3>& value) {
      for (Index i = 0; i < 3; ++i) col(i) = value.col(i);
      return *this;
    }

   private:
    Matrix<T, 4, 4>& matrix_;
  };
  Linear linear() { return Linear(matrix_); }
  [[nodiscard]] Matrix<T, 3, 3> linear() const { return linear_of(matrix_); }
  typename Linear::Column translation() { return typename Linear::Column(matrix_, 3); }
  [[nodiscard]] Matrix<T, 3, 1> translation() const {
    return {matrix_(0, 3), matrix_(1, 3), matrix_(2, 3)};
  }
  void makeAffine() {
    for (Index column = 0; column < 4; ++column) matrix_(3, column) = column == 3 ? T(1) : T(0);
  }
  // Linear part and translation.
  class Both {
   public:
    explicit Both(Matrix<T, 4, 4>& matrix) : matrix_(matrix) {}
    void operator*=(const T& factor) {
      for (Index row = 0; row < 3; ++row) {
        for (Index column = 0; column < 4; ++column) matrix_(row, column) *= factor;
      }
    }

   private:
    Matrix<T, 4, 4>& matrix_;
  };
  Both affine() { return Both(matrix_); }
  Matrix<T, 4, 4>& matrix() { return matrix_; }
  [[nodiscard]] const Matrix<T, 4, 4>& matrix() const { return matrix_; }

 private:
  static Matrix<T, 3, 3> linear_of(const Matrix<T, 4, 4>& matrix) {
    Matrix<T, 3, 3> out;
    for (Index row = 0; row < 3; ++row) {
      for (Index column = 0; column < 3; ++column) out(row, column) = matrix(row, column);
    }
    return out;
  }

  Matrix<T, 4, 4> matrix_;
};

}  // namespace Eigen
