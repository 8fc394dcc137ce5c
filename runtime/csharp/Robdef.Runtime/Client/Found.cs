// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Linq;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// A node that has announced itself. Nothing of this is proven: whether it is the node that it says it is shows in
/// connecting.
/// </summary>
/// <param name="Id">Its id.</param>
/// <param name="Name">Its name; empty for none.</param>
/// <param name="Urls">Of its service index; as a result of FindNode and FindNodes of the node, without a service.</param>
public sealed record DetectedNode(Guid Id, string Name, IReadOnlyList<string> Urls)
{
    internal static unsafe DetectedNode Of(in RrDetectedNode node) =>
        new(Copies.Id(node.Id), Failure.Text(node.Name), Copies.Texts(node.Urls, node.UrlCount));
}

/// <summary>A service that may be connected to, by what is known of it.</summary>
/// <param name="Name">Its name.</param>
/// <param name="Node">The id of its node; empty while unknown.</param>
/// <param name="NodeName">The name of its node; empty for none, and while unknown.</param>
/// <param name="Urls">All by which it may be reached, to be tried in this order: for <see cref="Runtime.Node.Subscribe{TStub}(IEnumerable{string}, SubscribeOptions?)"/>.</param>
/// <param name="ObjectType">The type of its root object, qualified.</param>
/// <param name="Implements">What that implements, qualified, without itself.</param>
/// <param name="Attributes">What it says about itself. Empty when it holds a type that is not one of the protocol.</param>
public sealed record FoundService(string Name, Guid Node, string NodeName, IReadOnlyList<string> Urls, string ObjectType,
    IReadOnlyList<string> Implements, IReadOnlyDictionary<string, VarValue?> Attributes)
{
    /// <summary>Whether the root object has this type, or implements it.</summary>
    public bool Is(string type) => ObjectType == type || Implements.Contains(type);

    internal static unsafe FoundService Of(in RrFoundService service) =>
        new(Failure.Text(service.Name), Copies.Id(service.Node), Failure.Text(service.NodeName),
            Copies.Texts(service.Urls, service.UrlCount), Failure.Text(service.ObjectType),
            Copies.Texts(service.Implements, service.ImplementCount), ReadAttributes(service.Attributes));

    private static Dictionary<string, VarValue?> ReadAttributes(in RrElements attributes)
    {
        try
        {
            return VarValueCodec.StringMap.Read(Elements.Reader(attributes, KnownTypes.None.Registry).Read()) ?? [];
        }
        catch (RobdefException)
        {
            // The service matters more than what it says with a type that only its own definition has.
            return [];
        }
    }
}

/// <summary>Native results of discovery, which are released when they have been read.</summary>
internal static unsafe class Results
{
    public static IReadOnlyList<DetectedNode> TakeNodes(nint nodes)
    {
        try
        {
            var result = new DetectedNode[checked((int)Functions.rr_detected_nodes_count(nodes))];
            for (int i = 0; i < result.Length; ++i)
            {
                var info = new RrDetectedNode { Size = (nuint)sizeof(RrDetectedNode) };
                nint error;
                Failure.Check(Functions.rr_detected_nodes_read(nodes, (nuint)i, &info, &error), error, KnownTypes.None);
                result[i] = DetectedNode.Of(info);
            }
            return result;
        }
        finally
        {
            Functions.rr_detected_nodes_release(nodes);
        }
    }

    /// <summary>The first one; null for none.</summary>
    public static DetectedNode? TakeNode(nint nodes)
    {
        IReadOnlyList<DetectedNode> all = TakeNodes(nodes);
        return all.Count == 0 ? null : all[0];
    }

    public static IReadOnlyList<FoundService> TakeServices(nint services)
    {
        try
        {
            var result = new FoundService[checked((int)Functions.rr_found_services_count(services))];
            for (int i = 0; i < result.Length; ++i)
            {
                var info = new RrFoundService { Size = (nuint)sizeof(RrFoundService) };
                nint error;
                Failure.Check(Functions.rr_found_services_read(services, (nuint)i, &info, &error), error, KnownTypes.None);
                result[i] = FoundService.Of(info);
            }
            return result;
        }
        finally
        {
            Functions.rr_found_services_release(services);
        }
    }
}
