// SPDX-License-Identifier: Apache-2.0
using System.Runtime.InteropServices;

namespace Robdef.Runtime.Native;

// The structs of rr_c/discovery.h and rr_c/filters.h, and those of services in rr_c/subscriptions.h, field by field.

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrAnnounceOptions
{
    public nuint Size;
    public uint Networks;
    public uint Port;
    public RrStr* Interfaces;
    public nuint InterfaceCount;
    public int PeriodMs;
    public uint Reserved;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrListenOptions
{
    public nuint Size;
    public uint Networks;
    public uint Port;
    public RrStr* Interfaces;
    public nuint InterfaceCount;
    public int LifetimeMs;
    public uint WithoutLocalNodes;
    public nuint MaxNodes;
    public nuint MaxNodesOfSender;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrDetectedNode
{
    public nuint Size;
    public RrNodeId Id;
    public RrStr Name;
    public RrStr* Urls;
    public nuint UrlCount;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrFoundService
{
    public nuint Size;
    public RrStr Name;
    public RrNodeId Node;
    public RrStr NodeName;
    public RrStr* Urls;
    public nuint UrlCount;
    public RrStr ObjectType;
    public RrStr* Implements;
    public nuint ImplementCount;
    public RrElements Attributes;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrDiscoveryHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrDetectedNode*, void> OnDetected;
    public delegate* unmanaged[Cdecl]<nint, RrDetectedNode*, void> OnLost;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrFindOptions
{
    public nuint Size;
    public RrStr* Schemes;
    public nuint SchemeCount;
    public int WaitMs;
    public int TimeoutMs;
    public nint Cancellation;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrAttributeTest
{
    public RrStr Value;
    public RrStr Name;
    public uint IsExpression;
    public uint Reserved;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrAttributeGroup
{
    public RrStr Attribute;
    public RrAttributeTest* Tests;
    public nuint TestCount;
    public RrAttributeGroup* Groups;
    public nuint GroupCount;
    public uint Match;
    public uint KeepsCommas;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrNodeFilter
{
    public RrNodeId Id;
    public RrStr Name;
    public RrStr Username;
    public RrStr Password;
    public RrElements Credentials;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServiceFilter
{
    public nuint Size;
    public RrNodeFilter* Nodes;
    public nuint NodeCount;
    public RrStr* ServiceNames;
    public nuint ServiceNameCount;
    public RrStr* TransportSchemes;
    public nuint TransportSchemeCount;
    public RrAttributeGroup* Attributes;
    public nuint AttributeCount;
    public uint AttributesMatch;
    public uint Reserved;
    public nuint MaxConnections;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrFoundService*, int> Predicate;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServiceUrls
{
    public RrStr* Urls;
    public nuint UrlCount;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrSubscribedClient
{
    public nuint Size;
    public RrNodeId Node;
    public RrStr Service;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrSubscribedService
{
    public nuint Size;
    public RrStr* Urls;
    public nuint UrlCount;
    public RrSubscribedClient* Client;
    public RrErrorInfo* LastError;
    public ulong Failures;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServiceSubscriptionHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void> OnConnected;
    public delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrErrorInfo*, void> OnDisconnected;
    public delegate* unmanaged[Cdecl]<nint, RrStr*, nuint, RrErrorInfo*, void> OnFailed;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServiceInfoHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrFoundService*, void> OnDetected;
    public delegate* unmanaged[Cdecl]<nint, RrFoundService*, void> OnChanged;
    public delegate* unmanaged[Cdecl]<nint, RrFoundService*, void> OnLost;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}
