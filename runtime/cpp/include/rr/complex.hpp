// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>

#include "rr/type.hpp"
#include "rr/visibility.hpp"

/// cdouble and csingle: real part, then imaginary part (03, section 4).
namespace RR_VISIBLE rr {

template <>
inline constexpr ElementType number_of<std::complex<double>> = ElementType::cdouble;
template <>
inline constexpr ElementType number_of<std::complex<float>> = ElementType::csingle;
static_assert(sizeof(std::complex<double>) == item_size(ElementType::cdouble));
static_assert(sizeof(std::complex<float>) == item_size(ElementType::csingle));

}  // namespace rr
