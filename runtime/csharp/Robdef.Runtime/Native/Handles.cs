// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.InteropServices;

namespace Robdef.Runtime.Native;

/// <summary>A native handle that is released once, when nothing uses it any more.</summary>
internal abstract class Handle : SafeHandle
{
    protected Handle(nint value)
        : base(0, ownsHandle: true) => SetHandle(value);

    public override bool IsInvalid => handle == 0;

    protected abstract void Release(nint value);

    protected override bool ReleaseHandle()
    {
        Release(handle);
        return true;
    }
}

internal sealed class NodeHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_node_release(value);
}

internal sealed class ClientHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_client_release(value);
}

internal sealed class RemoteHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_object_release(value);
}

internal sealed class SubscriptionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_subscription_release(value);
}

internal sealed class GeneratorHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_generator_release(value);
}

internal sealed class PipeHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_pipe_release(value);
}

internal sealed class WireHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_wire_release(value);
}

internal sealed class ServiceSubscriptionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_service_subscription_release(value);
}

internal sealed class WireSubscriptionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_wire_subscription_release(value);
}

internal sealed class PipeSubscriptionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_pipe_subscription_release(value);
}

internal sealed class ObjectSubscriptionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_object_subscription_release(value);
}

internal sealed class ServiceInfoSubscriptionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_service_info_subscription_release(value);
}

internal sealed class DefinitionHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_definition_release(value);
}

internal sealed class ObjectTypeHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_object_type_release(value);
}

internal sealed class ServedHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_served_object_release(value);
}

internal sealed class ServiceHandle(nint value) : Handle(value)
{
    protected override void Release(nint value) => Functions.rr_service_release(value);
}

/// <summary>Managed objects as the contexts of native functions.</summary>
internal static unsafe class Context
{
    public static nint Of(object target) => GCHandle.ToIntPtr(GCHandle.Alloc(target));

    public static T Get<T>(nint context)
        where T : class => (T)GCHandle.FromIntPtr(context).Target!;

    /// <summary>Frees a context: exactly once, by its drop or its completion.</summary>
    [UnmanagedCallersOnly(CallConvs = [typeof(System.Runtime.CompilerServices.CallConvCdecl)])]
    public static void Drop(nint context) => GCHandle.FromIntPtr(context).Free();

    public static void Free(nint context) => GCHandle.FromIntPtr(context).Free();
}
