// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "rr/authority.hpp"
#include "rr/node_id.hpp"

/// What an authority has issued: the file `index` of its folder. After a line with its version it
/// has a line for each certificate, in the order of issuing, fields separated by tabs:
///
///   serial  node id  not before  not after  issued, or revoked and the time  name
namespace rr::channel {

/// The certificates of the file; none when it is empty. Throws rr::Error (invalid_configuration),
/// naming the line.
std::vector<IssuedCertificate> read_index(const std::string& file);
/// Writes it whole or not at all.
void write_index(const std::string& file, const std::vector<IssuedCertificate>& issued);

/// A number as digits of a serial: hexadecimal, lower case, without zeros in front. Takes colons
/// between them; empty when it is none.
std::string serial_in(const std::string& text);

}  // namespace rr::channel
