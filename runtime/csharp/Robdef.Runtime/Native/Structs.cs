// SPDX-License-Identifier: Apache-2.0
using System.Runtime.InteropServices;

namespace Robdef.Runtime.Native;

// The structs of rr.h, field by field.

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrStr
{
    public byte* Data;
    public nuint Size;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrTime
{
    public long Seconds;
    public int Nanoseconds;
    public int Reserved;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrNodeId
{
    public fixed byte Bytes[16];
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrElements
{
    public byte* Data;
    public nuint Size;
    public uint Count;
    public uint Version;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrErrorInfo
{
    public nuint Size;
    public int Code;
    public uint Reserved;
    public RrStr Name;
    public RrStr Subname;
    public RrStr Message;
    public RrElements Parameter;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrCallOptions
{
    public nuint Size;
    public int TimeoutMs;
    public uint Access;
    public nint Cancellation;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrCompletion
{
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, nint, nint, void> Done;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrRequestInfo
{
    public nuint Size;
    public uint Kind;
    public uint Member;
    public RrElements Arguments;
    public uint AnswerVersion;
    public uint Client;
    public int IndexNumber;
    public uint Reserved;
    public RrStr Name;
    public RrNodeId Node;
    public ulong Session;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrNodeOptions
{
    public nuint Size;
    public RrStr Name;
    public RrNodeId Id;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, uint, RrStr, void> Log;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
    public uint ClientWithout;
    public uint ServerWithout;
    public uint ServerStringTable;
    public uint MaxThreads;
    public int RequestTimeoutMs;
    public int ConnectTimeoutMs;
    public int FirstMessageTimeoutMs;
    public int HeartbeatPeriodMs;
    public int ReceiveTimeoutMs;
    public int KeepAlivePeriodMs;
    public int ClientTimeoutMs;
    public int GeneratorTimeoutMs;
    public uint MessageSize;
    public uint MemoryTransferLimit;
    public ulong SendQueueLimit;
    public ulong RequestQueueLimit;
    public ulong MaxConnections;
    public RrTlsOptions* Tls;
    public RrAuditOptions* Audit;
    public uint SharedMemory;
    public uint SpinUs;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrConnectOptions
{
    public nuint Size;
    public RrStr Username;
    public RrStr Password;
    public RrElements Credentials;
    public RrStr ObjectType;
    public int RequestTimeoutMs;
    public uint AllowClearCredentials;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrErrorInfo*, void> OnClosed;
    public delegate* unmanaged[Cdecl]<nint, RrStr, void> OnPathReleased;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrSubscribeOptions
{
    public nuint Size;
    public RrStr Username;
    public RrStr Password;
    public RrElements Credentials;
    public RrStr ObjectType;
    public int RequestTimeoutMs;
    public int RetryDelayMs;
    public int MaxRetryDelayMs;
    public int ConnectTimeoutMs;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void> OnConnected;
    public delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrErrorInfo*, void> OnDisconnected;
    public delegate* unmanaged[Cdecl]<nint, RrErrorInfo*, void> OnFailed;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
    public RrServiceFilter* Filter;
    public uint AllowClearCredentials;
    public uint Reserved;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrIndex
{
    public uint Form;
    public int Number;
    public RrStr Text;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrEventHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrElements*, nint, void> OnEvent;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrCallbackHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, nint, void> OnCall;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrMemoryType
{
    public uint Element;
    public uint IsMulti;
    public uint Access;
    public uint TransferSize;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrMemoryPieces
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, ulong, ulong*, nuint, RrElements*, int> Take;
    public delegate* unmanaged[Cdecl]<nint, ulong, ulong*, nuint, nint, int> Give;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrPipeOptions
{
    public nuint Size;
    public uint Access;
    public int Index;
    public uint Reliable;
    public uint Reserved;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrPipeHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrElements*, nint, void> OnPacket;
    public delegate* unmanaged[Cdecl]<nint, uint, void> OnAcknowledged;
    public delegate* unmanaged[Cdecl]<nint, void> OnClosed;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrWireHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrElements*, RrTime*, nint, void> OnValue;
    public delegate* unmanaged[Cdecl]<nint, void> OnClosed;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

/// <summary>rr_wire_subscription_handler and rr_pipe_subscription_handler, which differ in their function.</summary>
[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrSubscriptionHandler
{
    public nuint Size;
    public nint Context;
    public void* OnReceived;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrMember
{
    public RrStr Name;
    public uint Kind;
    public uint Access;
    public uint ReturnsValue;
    public uint Generator;
    public uint Index;
    public uint Reserved;
    public RrStr ObjectType;
    public RrMemoryType Memory;
    public delegate* unmanaged[Cdecl]<nint, RrElements*, int> Check;
    public nint CheckContext;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrObjectHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, nint, RrRequestInfo*, void> OnRequest;
    public delegate* unmanaged[Cdecl]<nint, nint, RrStr, void> OnAttached;
    public delegate* unmanaged[Cdecl]<nint, RrStr, void> OnReleased;
    public delegate* unmanaged[Cdecl]<nint, int, int> OnMonitorEnter;
    public delegate* unmanaged[Cdecl]<nint, void> OnMonitorExit;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrGeneratorHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, nint, RrRequestInfo*, void> OnStep;
    public delegate* unmanaged[Cdecl]<nint, int, void> OnEnd;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServedPipeHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, nint, void> OnConnect;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServedWireHandler
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, nint, void> OnConnect;
    public delegate* unmanaged[Cdecl]<nint, uint, RrElements*, RrTime*, nint, void> OnValue;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
    public uint HandlesPeekIn;
    public uint HandlesPeekOut;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrMemorySource
{
    public nuint Size;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, ulong*, nuint, nuint*, int> Dims;
    public delegate* unmanaged[Cdecl]<nint, ulong*, ulong*, nuint, void*, nuint, int> Read;
    public delegate* unmanaged[Cdecl]<nint, ulong*, ulong*, nuint, void*, nuint, int> Write;
    public delegate* unmanaged[Cdecl]<nint, ulong*, ulong*, nuint, nint, int> ReadPiece;
    public delegate* unmanaged[Cdecl]<nint, ulong*, ulong*, nuint, RrElements*, int> WritePiece;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
}

[StructLayout(LayoutKind.Sequential)]
internal struct RrClientInfo
{
    public nuint Size;
    public uint Client;
    public uint Reserved;
    public RrNodeId Node;
    public RrStr NodeName;
    public RrStr User;
    public ulong Session;
}

[StructLayout(LayoutKind.Sequential)]
internal unsafe struct RrServiceOptions
{
    public nuint Size;
    public RrElements Attributes;
    public nint* ExtraDefinitions;
    public nuint ExtraDefinitionCount;
    public nint Users;
    public uint UserIsOptional;
    public int MonitorPatienceMs;
    public nint Context;
    public delegate* unmanaged[Cdecl]<nint, RrClientInfo*, void> OnClientConnected;
    public delegate* unmanaged[Cdecl]<nint, RrClientInfo*, void> OnClientDisconnected;
    public delegate* unmanaged[Cdecl]<nint, void> Drop;
    public delegate* unmanaged[Cdecl]<nint, RrClientInfo*, void> OnClientLeaving;
    public RrStr* Rights;
    public RrStr RightsFile;
}
