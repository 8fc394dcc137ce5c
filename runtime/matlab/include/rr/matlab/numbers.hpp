// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "rr/matlab/fits.hpp"
#include "rr/matlab/misfit.hpp"

/// Numbers between the interpreter and C++. Complex arrays have their parts apart, which is how
/// Octave and MATLAB build MEX files unless they are told otherwise. For the interpreter's thread.
namespace rr::matlab {

/// Sizes of an array in the interpreter.
using Dims = std::vector<mwSize>;

/// The class of the interpreter that holds a T.
template <class T>
constexpr mxClassID class_of_number() {
  if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::complex<double>>) {
    return mxDOUBLE_CLASS;
  } else if constexpr (std::is_same_v<T, float> || std::is_same_v<T, std::complex<float>>) {
    return mxSINGLE_CLASS;
  } else if constexpr (std::is_same_v<T, bool>) {
    return mxLOGICAL_CLASS;
  } else if constexpr (std::is_signed_v<T>) {
    constexpr std::array classes{mxINT8_CLASS, mxINT16_CLASS, mxINT32_CLASS, mxINT64_CLASS};
    return classes[sizeof(T) == 8 ? 3 : sizeof(T) / 2];
  } else {
    constexpr std::array classes{mxUINT8_CLASS, mxUINT16_CLASS, mxUINT32_CLASS, mxUINT64_CLASS};
    return classes[sizeof(T) == 8 ? 3 : sizeof(T) / 2];
  }
}

/// What a value is, for messages: `double`, `sparse double`, `2x3 int8`.
inline std::string described(const mxArray* value) {
  std::string text;
  const mwSize* const dims = mxGetDimensions(value);
  const auto rank = static_cast<std::size_t>(mxGetNumberOfDimensions(value));
  if (mxGetNumberOfElements(value) != 1) {
    for (std::size_t i = 0; i < rank; ++i) text += (i == 0 ? "" : "x") + std::to_string(dims[i]);
    text += " ";
  }
  if (mxIsSparse(value)) text += "sparse ";
  if (mxIsComplex(value)) text += "complex ";
  return text + mxGetClassName(value);
}

/// Numbers or logicals, not sparse.
inline bool is_numeric(const mxArray* value) {
  return (mxIsNumeric(value) || mxIsLogical(value)) && !mxIsSparse(value);
}

inline std::size_t count_of(const mxArray* value) {
  return static_cast<std::size_t>(mxGetNumberOfElements(value));
}

/// Whether it has at most one size other than one, or no items.
inline bool is_vector(const mxArray* value) {
  const mwSize* const dims = mxGetDimensions(value);
  const auto rank = static_cast<std::size_t>(mxGetNumberOfDimensions(value));
  std::size_t longer = 0;
  for (std::size_t i = 0; i < rank; ++i) longer += dims[i] != 1 ? 1 : 0;
  return longer <= 1 || count_of(value) == 0;
}

inline Dims dims_of(const mxArray* value) {
  const mwSize* const dims = mxGetDimensions(value);
  return {dims, dims + mxGetNumberOfDimensions(value)};
}

/// Calls `use` with a null pointer to the C++ type of the items. Not for what is no number.
template <class Use>
void with_class(const mxArray* value, Use&& use) {
  switch (mxGetClassID(value)) {
    case mxSINGLE_CLASS:
      return use(static_cast<const float*>(nullptr));
    case mxINT8_CLASS:
      return use(static_cast<const std::int8_t*>(nullptr));
    case mxUINT8_CLASS:
      return use(static_cast<const std::uint8_t*>(nullptr));
    case mxINT16_CLASS:
      return use(static_cast<const std::int16_t*>(nullptr));
    case mxUINT16_CLASS:
      return use(static_cast<const std::uint16_t*>(nullptr));
    case mxINT32_CLASS:
      return use(static_cast<const std::int32_t*>(nullptr));
    case mxUINT32_CLASS:
      return use(static_cast<const std::uint32_t*>(nullptr));
    case mxINT64_CLASS:
      return use(static_cast<const std::int64_t*>(nullptr));
    case mxUINT64_CLASS:
      return use(static_cast<const std::uint64_t*>(nullptr));
    case mxLOGICAL_CLASS:
      return use(static_cast<const bool*>(nullptr));
    default:
      return use(static_cast<const double*>(nullptr));
  }
}

template <class From>
std::string text_of_number(From number) {
  if constexpr (std::is_integral_v<From>) {
    return std::to_string(number);
  } else {
    if (std::isnan(number)) return "NaN";
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.17g", static_cast<double>(number));
    return text.data();
  }
}

/// Copies `count` numbers of one part of an array to places `stride` apart. Throws Misfit.
template <class To, class From>
void copy_numbers(const From* from, std::size_t count, To* to, std::size_t stride = 1) {
  if constexpr (std::is_same_v<To, From>) {
    if (stride == 1) {
      if (count != 0) std::memcpy(to, from, count * sizeof(To));
      return;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (take_number(from[i], to[i * stride])) continue;
    Misfit misfit(std::string(word_of_number<To>()) + " cannot hold " + text_of_number(from[i]));
    if (count != 1) misfit.enter_item(i);
    throw misfit;
  }
}

/// Copies all numbers of an array to `to`, in their order in memory: the first index is the
/// fastest. Throws Misfit.
template <class To>
void read_numbers(const mxArray* value, To* to) {
  if (!is_numeric(value)) {
    throw Misfit("expected " + std::string(word_of_number<To>()) + ", got " + described(value));
  }
  const std::size_t count = count_of(value);
  if (count == 0) return;
  with_class(value, [&]<class From>(const From*) {
    const auto* const real = static_cast<const From*>(mxGetData(value));
    const auto* const imaginary =
        mxIsComplex(value) ? static_cast<const From*>(mxGetImagData(value)) : nullptr;
    if constexpr (is_complex_number<To>) {
      using Part = typename To::value_type;
      Part* const parts = reinterpret_cast<Part*>(to);
      copy_numbers(real, count, parts, 2);
      if (imaginary != nullptr) {
        copy_numbers(imaginary, count, parts + 1, 2);
      } else {
        for (std::size_t i = 0; i < count; ++i) parts[2 * i + 1] = Part{};
      }
    } else {
      for (std::size_t i = 0; imaginary != nullptr && i < count; ++i) {
        if (imaginary[i] == From{}) continue;
        throw Misfit("expected " + std::string(word_of_number<To>()) + ", got " + described(value));
      }
      copy_numbers(real, count, to);
    }
  });
}

/// The one number of an array. Throws Misfit.
template <class To>
To read_number(const mxArray* value) {
  if (!is_numeric(value) || count_of(value) != 1) {
    throw Misfit("expected " + std::string(word_of_number<To>()) + ", got " + described(value));
  }
  To number{};
  read_numbers(value, &number);
  return number;
}

/// A row or column as a vector; an empty array is one without items. Throws Misfit.
template <class To>
std::vector<To> read_vector(const mxArray* value) {
  if (!is_numeric(value) || !is_vector(value)) {
    throw Misfit("expected " + std::string(word_of_number<To>()) + "[], got " + described(value));
  }
  std::vector<To> numbers(count_of(value));
  read_numbers(value, numbers.data());
  return numbers;
}

/// At least two sizes, as the interpreter wants them; one size makes a column.
inline Dims full_dims(Dims dims) {
  if (dims.empty()) return {0, 0};
  if (dims.size() == 1) dims.push_back(1);
  return dims;
}

/// Room for numbers whose contents the caller sets. Above 64 KiB it is the interpreter's own, so
/// that Octave does not copy it when it is returned.
template <class T>
mxArray* make_room(const Dims& dims) {
  std::size_t size = sizeof(T);
  for (const mwSize dim : dims) size *= static_cast<std::size_t>(dim);
  if constexpr (!is_complex_number<T> && !std::is_same_v<T, bool>) {
    if (size >= std::size_t{64} * 1024) {
      mxArray* sizes = mxCreateDoubleMatrix(1, static_cast<mwSize>(dims.size()), mxREAL);
      for (std::size_t i = 0; i < dims.size(); ++i) {
        static_cast<double*>(mxGetData(sizes))[i] = static_cast<double>(dims[i]);
      }
      // NOLINTNEXTLINE(bugprone-suspicious-stringview-data-usage): the words are literals.
      mxArray* arguments[] = {sizes, mxCreateString(word_of_number<T>().data())};
      mxArray* room = nullptr;
      mxArray* const failure = mexCallMATLABWithTrap(1, &room, 2, arguments, "zeros");
      for (mxArray* argument : arguments) mxDestroyArray(argument);
      if (failure == nullptr) return room;
      mxDestroyArray(failure);
      throw Error(ErrorCode::out_of_system_resource,
                  "the interpreter has no room for an array of " + std::to_string(size) + " bytes");
    }
  }
  const auto rank = static_cast<mwSize>(dims.size());
  if constexpr (std::is_same_v<T, bool>) return mxCreateLogicalArray(rank, dims.data());
  return mxCreateNumericArray(rank, dims.data(), class_of_number<T>(),
                              is_complex_number<T> ? mxCOMPLEX : mxREAL);
}

/// Octave makes arrays of MEX files real whose imaginary parts are all 0, or -0. Those that its own
/// function has made stay complex. Takes both parts over.
inline mxArray* make_complex(mxArray* real, mxArray* imaginary) {
  mxArray* parts[] = {real, imaginary};
  mxArray* array = nullptr;
  mxArray* const failure = mexCallMATLABWithTrap(1, &array, 2, parts, "complex");
  for (mxArray* const part : parts) mxDestroyArray(part);
  if (failure == nullptr) return array;
  mxDestroyArray(failure);
  throw Error(ErrorCode::out_of_system_resource, "the interpreter has no room for complex numbers");
}

template <class Part>
mxArray* make_complex_numbers(std::span<const std::complex<Part>> items, const Dims& dims) {
  bool is_kept = false;
  for (const auto& item : items) is_kept = is_kept || item.imag() != Part{};
  mxArray* const whole = is_kept ? make_room<std::complex<Part>>(dims) : nullptr;
  mxArray* const real_part = is_kept ? whole : make_room<Part>(dims);
  mxArray* const imaginary_part = is_kept ? whole : make_room<Part>(dims);
  auto* const real = static_cast<Part*>(mxGetData(real_part));
  auto* const imaginary =
      static_cast<Part*>(is_kept ? mxGetImagData(whole) : mxGetData(imaginary_part));
  for (std::size_t i = 0; i < items.size(); ++i) {
    real[i] = items[i].real();
    imaginary[i] = items[i].imag();
  }
  return is_kept ? whole : make_complex(real_part, imaginary_part);
}

/// An array of these sizes, whose product is the number of items; see full_dims().
template <class T>
mxArray* make_numbers(std::span<const T> items, const Dims& dims) {
  if constexpr (is_complex_number<T>) {
    return make_complex_numbers<typename T::value_type>(items, dims);
  } else {
    mxArray* const array = make_room<T>(dims);
    if (!items.empty()) std::memcpy(mxGetData(array), items.data(), items.size_bytes());
    return array;
  }
}

/// A column.
template <class T>
mxArray* make_column(std::span<const T> items) {
  return make_numbers<T>(items, {static_cast<mwSize>(items.size()), 1});
}

template <class T>
mxArray* make_number(T number) {
  if constexpr (std::is_same_v<T, double>) return mxCreateDoubleScalar(number);
  return make_column<T>(std::span<const T>(&number, 1));
}

}  // namespace rr::matlab
