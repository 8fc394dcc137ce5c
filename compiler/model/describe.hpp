// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/model/model.hpp"

namespace robdef::model {

/// A readable outline of one definition for people: what it is, what it needs, and each declaration
/// in the order of the file with its documentation. Types are named as in the file. Sizes of pods
/// and namedarrays and the numbers of enum values are given.
std::string describe(const Definition& definition);

}  // namespace robdef::model
