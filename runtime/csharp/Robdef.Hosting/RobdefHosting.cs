// SPDX-License-Identifier: Apache-2.0
using System;
using System.Linq;
using Microsoft.Extensions.DependencyInjection;
using Microsoft.Extensions.DependencyInjection.Extensions;
using Robdef.Runtime;

namespace Robdef.Hosting;

/// <summary>A node as a part of a .NET host.</summary>
public static class RobdefHosting
{
    /// <summary>
    /// Adds a node that starts and stops with the host, writes to its loggers (category `Robdef.Runtime`) and offers the services that
    /// are added to it. <see cref="RobdefHost"/> gives others the node. A host has one node; a second call adds to it.
    /// </summary>
    /// <param name="services">Of the host.</param>
    /// <param name="configure">Name, URLs and options.</param>
    public static RobdefNodeBuilder AddRobdefNode(this IServiceCollection services, Action<RobdefNodeSettings>? configure = null)
    {
        ArgumentNullException.ThrowIfNull(services);
        services.AddOptions<RobdefNodeSettings>();
        if (configure is not null)
        {
            services.Configure(configure);
        }
        services.TryAddSingleton<RobdefHost>();
        services.AddHostedService<RobdefNodeService>();
        return new RobdefNodeBuilder(services);
    }
}

/// <summary>Says what the node of a host offers.</summary>
public sealed class RobdefNodeBuilder
{
    internal RobdefNodeBuilder(IServiceCollection services) => Services = services;

    /// <summary>Of the host.</summary>
    public IServiceCollection Services { get; }

    /// <summary>
    /// Offers a service. Its root object is made by the host once, with what its constructor asks for.
    /// </summary>
    /// <typeparam name="TSkeleton">The class of the root object.</typeparam>
    /// <param name="name">The service's name: a letter, then letters, digits and underscores.</param>
    /// <param name="options">Users, rights and attributes.</param>
    /// <exception cref="ArgumentException">There is a service of that name.</exception>
    public RobdefNodeBuilder AddService<[System.Diagnostics.CodeAnalysis.DynamicallyAccessedMembers(
        System.Diagnostics.CodeAnalysis.DynamicallyAccessedMemberTypes.PublicConstructors)] TSkeleton>(
        string name, Func<IServiceProvider, ServiceOptions>? options = null)
        where TSkeleton : Skeleton
    {
        if (Services.Any(one => one.ImplementationInstance is OfferedService offered && offered.Name == name))
        {
            throw new ArgumentException($"the node has a service `{name}` already", nameof(name));
        }
        Services.TryAddSingleton<TSkeleton>();
        Services.AddSingleton(new OfferedService(name, static provider => provider.GetRequiredService<TSkeleton>(),
            options ?? (static _ => new ServiceOptions())));
        return this;
    }
}
