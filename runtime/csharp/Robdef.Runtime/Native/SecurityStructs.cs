// SPDX-License-Identifier: Apache-2.0
using System.Runtime.InteropServices;

namespace Robdef.Runtime.Native;

// The structs of rr_c/security.h, field by field.

[StructLayout(LayoutKind.Sequential)]
internal struct RrPin
{
    public RrNodeId Node;
    public RrStr Sha256;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrTlsOptions
{
    public nuint Size;
    public RrStr CertificateFile;
    public RrStr KeyFile;
    public RrStr* AuthorityFiles;
    public nuint AuthorityFileCount;
    public RrStr* RevocationFiles;
    public nuint RevocationFileCount;
    public RrPin* Pins;
    public nuint PinCount;
    public uint IsRequired;
    public uint MustCertifyClients;
    public uint SystemAuthorities;
    public uint AcceptsOutdatedLists;
    public int LookAgainPeriodMs;
    public uint Reserved;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrAuditOptions
{
    public nuint Size;
    public RrStr File;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrStr, void> OnEvent;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
    public ulong MaxSize;
    public uint KeptFiles;
    public uint Requests;
    public ulong Refusals;
}
