// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <string_view>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/writer.hpp"

/// Errors to entries and back (07, section 14).
namespace rr::endpoint {

/// Writes the elements of an error entry; returns how many. A parameter that cannot travel is left
/// out.
std::uint32_t write_error(Writer& writer, const Error& error);

/// What a failed entry reports, as the exception to be thrown: the class of a known definition for
/// a remote error of that name, else rr::Error.
std::exception_ptr read_error(const Message& message, const Entry& entry, const MemoryRef& owner,
                              const TypeRegistry& types);

/// What is told to the other side about an exception that user code threw.
Error describe(const std::exception_ptr& exception);

/// The error that a decoder or writer has latched.
Error latched(const Latch& latch);

}  // namespace rr::endpoint
