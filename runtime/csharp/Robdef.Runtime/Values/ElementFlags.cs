// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>What an element of message version 4 has (02, section 4).</summary>
[Flags]
internal enum ElementFlags : byte
{
    None = 0,
    Name = 0x01,
    NameCode = 0x02,
    Number = 0x04,
    TypeName = 0x08,
    TypeNameCode = 0x10,
    Metadata = 0x20,
    Extended = 0x80,
}
