// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>How the answers of several tests make one. Of no tests, AllOf and AnyOf hold, the other two do not.</summary>
public enum Match
{
    /// <summary>One holds.</summary>
    AnyOf = 1,

    /// <summary>All hold.</summary>
    AllOf = 2,

    /// <summary>None holds.</summary>
    NoneOf = 3,

    /// <summary>One does not hold.</summary>
    NotAllOf = 4,
}

/// <summary>
/// One test of an attribute's texts. A text with commas is several texts; lists hold their items' texts; other values
/// have none. A missing attribute is as an empty list.
/// </summary>
/// <param name="Value">The text.</param>
public sealed record AttributeTest(string Value)
{
    /// <summary>The value is a regular expression (ECMAScript) that the whole text must match.</summary>
    public bool IsExpression { get; init; }

    /// <summary>In an attribute that is a map from string: which of its values. Empty: all of them.</summary>
    public string Name { get; init; } = "";
}

/// <summary>Tests of one attribute, and groups of such tests.</summary>
public sealed record AttributeGroup
{
    /// <summary>No tests yet.</summary>
    public AttributeGroup()
    {
    }

    /// <summary>The attribute has one of these texts.</summary>
    public AttributeGroup(params string[] values) => Tests = Array.ConvertAll(values, static value => new AttributeTest(value));

    /// <summary>Tests of the attribute.</summary>
    public IReadOnlyList<AttributeTest> Tests { get; init; } = [];

    /// <summary>Further groups of tests of the same attribute, up to 16 deep.</summary>
    public IReadOnlyList<AttributeGroup> Groups { get; init; } = [];

    /// <summary>How their answers make one.</summary>
    public Match Match { get; init; } = Match.AnyOf;

    /// <summary>Whether a text with commas is cut there.</summary>
    public bool SplitsAtCommas { get; init; } = true;
}

/// <summary>A node whose services are wanted, and the user to log in with.</summary>
public sealed record NodeFilter
{
    /// <summary>Its id; empty: any.</summary>
    public Guid Id { get; init; }

    /// <summary>Its name; empty: any.</summary>
    public string Name { get; init; } = "";

    /// <summary>The user; empty: as the subscription's options say.</summary>
    public string UserName { get; init; } = "";

    /// <summary>The user's password.</summary>
    public string Password { get; init; } = "";

    /// <summary>What the user shows instead of a password.</summary>
    public Dictionary<string, VarValue?>? Credentials { get; init; }
}

/// <summary>
/// Which services a subscription is for: all that is filled in must hold. What a URL does not tell is looked at once
/// connected; a service that does not match is left again, which counts as a failure (ServiceNotFound).
/// </summary>
public sealed record ServiceFilter
{
    /// <summary>One of these. The first that fits says who logs in.</summary>
    public IReadOnlyList<NodeFilter> Nodes { get; init; } = [];

    /// <summary>One of these.</summary>
    public IReadOnlyList<string> ServiceNames { get; init; } = [];

    /// <summary>`rr+tcp`, ...: URLs of other schemes are not tried. Empty: all.</summary>
    public IReadOnlyList<string> TransportSchemes { get; init; } = [];

    /// <summary>Tests of attributes, by name.</summary>
    public IReadOnlyDictionary<string, AttributeGroup> Attributes { get; init; } = new Dictionary<string, AttributeGroup>();

    /// <summary>How the answers for several attributes make one.</summary>
    public Match AttributesMatch { get; init; } = Match.AllOf;

    /// <summary>
    /// Has the last word. On a thread of the node; may be called for several services at once. What it throws goes to
    /// <see cref="Unhandled.Thrown"/>, and the service is not wanted.
    /// </summary>
    public Func<FoundService, bool>? Predicate { get; init; }

    /// <summary>Services that are connected at a time; 0: any number.</summary>
    public int MaxConnections { get; init; }

    /// <summary>The native form, whose call must follow: it takes over the context. Null for null.</summary>
    internal static unsafe RrServiceFilter* Write(NativeScope scope, ServiceFilter? filter)
    {
        if (filter is null)
        {
            return null;
        }
        ArgumentOutOfRangeException.ThrowIfNegative(filter.MaxConnections);
        RrServiceFilter* native = scope.New<RrServiceFilter>(1);
        native->Size = (nuint)sizeof(RrServiceFilter);
        native->Nodes = scope.New<RrNodeFilter>(filter.Nodes.Count);
        native->NodeCount = (nuint)filter.Nodes.Count;
        for (int i = 0; i < filter.Nodes.Count; ++i)
        {
            NodeFilter node = filter.Nodes[i];
            native->Nodes[i] = new RrNodeFilter
            {
                Id = Copies.Id(node.Id),
                Name = scope.Text(node.Name),
                Username = scope.Text(node.UserName),
                Password = scope.Text(node.Password),
                Credentials = scope.Map(node.Credentials),
            };
        }
        native->ServiceNames = scope.Texts(filter.ServiceNames, out native->ServiceNameCount);
        native->TransportSchemes = scope.Texts(filter.TransportSchemes, out native->TransportSchemeCount);
        native->Attributes = scope.New<RrAttributeGroup>(filter.Attributes.Count);
        foreach ((string name, AttributeGroup group) in filter.Attributes)
        {
            native->Attributes[native->AttributeCount++] = Write(scope, group, scope.Text(name));
        }
        native->AttributesMatch = (uint)filter.AttributesMatch;
        native->MaxConnections = (nuint)filter.MaxConnections;
        if (filter.Predicate is { } predicate)
        {
            native->Context = Context.Of(new PredicateSink(predicate));
            native->Predicate = &PredicateSink.OnAsked;
            native->Drop = &Context.Drop;
        }
        return native;
    }

    private static unsafe RrAttributeGroup Write(NativeScope scope, AttributeGroup group, RrStr name)
    {
        RrAttributeTest* tests = scope.New<RrAttributeTest>(group.Tests.Count);
        for (int i = 0; i < group.Tests.Count; ++i)
        {
            AttributeTest test = group.Tests[i];
            tests[i] = new RrAttributeTest
            {
                Value = scope.Text(test.Value),
                Name = scope.Text(test.Name),
                IsExpression = test.IsExpression ? 1u : 0,
            };
        }
        RrAttributeGroup* groups = scope.New<RrAttributeGroup>(group.Groups.Count);
        for (int i = 0; i < group.Groups.Count; ++i)
        {
            groups[i] = Write(scope, group.Groups[i], default);
        }
        return new RrAttributeGroup
        {
            Attribute = name,
            Tests = tests,
            TestCount = (nuint)group.Tests.Count,
            Groups = groups,
            GroupCount = (nuint)group.Groups.Count,
            Match = (uint)group.Match,
            KeepsCommas = group.SplitsAtCommas ? 0u : 1,
        };
    }
}

/// <summary>Where the native runtime asks about services.</summary>
internal sealed unsafe class PredicateSink(Func<FoundService, bool> predicate)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static int OnAsked(nint context, RrFoundService* service)
    {
        try
        {
            return Context.Get<PredicateSink>(context).Ask(FoundService.Of(*service)) ? 1 : 0;
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
            return 0;
        }
    }

    private bool Ask(FoundService service) => predicate(service);
}
