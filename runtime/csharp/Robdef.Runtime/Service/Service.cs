// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>How a service is offered.</summary>
public sealed record ServiceOptions
{
    /// <summary>What clients may ask about the service.</summary>
    public Dictionary<string, VarValue?>? Attributes { get; init; }

    /// <summary>Users with passwords, one a line, as docs/c-abi.md says; empty: anybody, and no object can be locked.</summary>
    public string Users { get; init; } = "";

    /// <summary>With users: clients may connect without one.</summary>
    public bool UserIsOptional { get; init; }

    /// <summary>Definitions whose types may be in varvalues and varobjects, beside that of the root.</summary>
    public IReadOnlyList<ServiceDefinition> ExtraDefinitions { get; init; } = [];
}

/// <summary>A service that a node offers. Disposing it lets go of it; the service goes on until it is closed or the node ends.</summary>
public sealed class Service : IDisposable
{
    private readonly ServiceHandle _handle;

    private Service(ServiceHandle handle) => _handle = handle;

    /// <summary>Tells all clients that the service is closed, and ends their sessions. The name is free again.</summary>
    public void Close() => Functions.rr_service_close(_handle);

    /// <summary>Forgets the object at a path and those below, and tells the clients.</summary>
    public unsafe void ReleasePath(string path)
    {
        using var text = new NativeText(path);
        nint error;
        Failure.Check(Functions.rr_service_release_path(_handle, text.Value, 0, &error), error, KnownTypes.None);
    }

    /// <summary>Lets go of the service, which goes on.</summary>
    public void Dispose() => _handle.Dispose();

    internal static unsafe Service Register(Node node, string name, Skeleton root, ServiceOptions options)
    {
        KnownTypes types = root.RrTypes;
        using var text = new NativeText(name);
        using ElementWriter writer = new(MessageVersion.V4);
        if (options.Attributes is not null)
        {
            VarValueCodec.StringMap.Write(writer, "attributes"u8, options.Attributes);
        }
        var extra = new nint[options.ExtraDefinitions.Count];
        for (int i = 0; i < extra.Length; ++i)
        {
            extra[i] = options.ExtraDefinitions[i].Handle.DangerousGetHandle();
        }
        nint error;
        nint users = 0;
        if (options.Users.Length != 0)
        {
            using var lines = new NativeText(options.Users);
            Failure.Check(Functions.rr_users_from_text(lines.Value, out users, &error), error, types);
        }
        fixed (byte* attributes = writer.Written)
        fixed (nint* definitions = extra)
        {
            var native = new RrServiceOptions
            {
                Size = (nuint)sizeof(RrServiceOptions),
                Attributes = Elements.Of(attributes, writer),
                ExtraDefinitions = definitions,
                ExtraDefinitionCount = (nuint)extra.Length,
                Users = users,
                UserIsOptional = options.UserIsOptional ? 1u : 0,
            };
            int status = Functions.rr_service_register(node.Handle, text.Value, root.RrServe(), &native, out nint service, &error);
            if (users != 0)
            {
                Functions.rr_users_release(users);
            }
            Failure.Check(status, error, types);
            return new Service(new ServiceHandle(service));
        }
    }
}
