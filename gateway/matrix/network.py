# SPDX-License-Identifier: Apache-2.0
"""Networks of the fleet matrix: a hub, which is where the matrix itself runs, and one for each site and the readers.

Each is linked with the hub. The matrix runs in namespaces of its own, so all of it ends with it.
"""
import os
import shutil
import socket
import subprocess
import sys
import time

from programs import Failure, Program, run, wait_until

HUB = "10.77.0.1"


def has_netem():
    """Whether this kernel delays and drops packets by itself."""
    return subprocess.run(["tc", "qdisc", "add", "dev", "lo", "root", "netem", "delay", "0ms"],
                          stderr=subprocess.DEVNULL, check=False).returncode == 0 and \
        subprocess.run(["tc", "qdisc", "del", "dev", "lo", "root"], check=False).returncode == 0


class NetemLink:
    """Two ends of a virtual cable, each of which delays and drops what it sends."""

    programs = ()

    def __init__(self, _folder, name):
        self.name = name
        run("ip", "link", "add", f"to-{name}", "type", "veth", "peer", "name", "hub", "netns", name)

    def impair(self, delay, loss):
        how = ["root", "netem", "delay", f"{delay}ms", "loss", f"{loss}%", "limit", "100000"]
        run("tc", "qdisc", "replace", "dev", f"to-{self.name}", *how)
        run("ip", "netns", "exec", self.name, "tc", "qdisc", "replace", "dev", "hub", *how)


class WireLink:
    """The same by wirefilter between two switches of VDE, each of which has an interface of its network."""

    def __init__(self, folder, name):
        self.name = name
        ends = [os.path.join(folder, f"{name}.{side}") for side in ("hub", "site")]
        self.programs = [Program(folder, f"switch-{name}-hub", ["vde_switch", "-s", ends[0], "-tap", f"to-{name}"]),
                         Program(folder, f"switch-{name}", ["vde_switch", "-s", ends[1], "-tap", "hub"], name)]
        wait_until(lambda: all(os.path.exists(end + "/ctl") for end in ends), 10, f"switches of {name}")
        control = os.path.join(folder, f"{name}.wire")
        self.programs.append(Program(folder, f"wire-{name}", ["wirefilter", "-v", ":".join(ends), "-M", control]))
        wait_until(lambda: os.path.exists(control), 10, f"wire of {name}")
        self.control = socket.socket(socket.AF_UNIX)
        self.control.settimeout(10)
        self.control.connect(control)
        self.answer()

    def answer(self):
        """Up to the next prompt."""
        text = ""
        while not text.endswith("VDEwf$ "):
            part = self.control.recv(4096)
            if not part:
                raise Failure(f"the wire of {self.name} has ended: {text}")
            text += part.decode()
        return text

    def impair(self, delay, loss):
        for command in (f"delay {delay}", f"loss {loss}"):
            self.control.send((command + "\n").encode())
            text = self.answer()
            if "1000 Success" not in text:
                raise Failure(f"wirefilter: {command}: {text}")


class Networks:
    def __init__(self, folder, names):
        os.makedirs("/run/netns", exist_ok=True)
        run("mount", "-t", "tmpfs", "none", "/run/netns")
        run("ip", "link", "set", "lo", "up")
        run("ip", "addr", "add", f"{HUB}/32", "dev", "lo")
        self.kind = NetemLink if has_netem() else WireLink
        self.links = {}
        for number, name in enumerate(names, 1):
            run("ip", "netns", "add", name)
            run("ip", "netns", "exec", name, "ip", "link", "set", "lo", "up")
            self.links[name] = self.kind(folder, name)
            run("ip", "addr", "add", f"10.77.{number}.1/24", "dev", f"to-{name}")
            run("ip", "link", "set", f"to-{name}", "up")
            inside = ["ip", "netns", "exec", name, "ip"]
            run(*inside, "addr", "add", f"10.77.{number}.2/24", "dev", "hub")
            run(*inside, "link", "set", "hub", "up")
            run(*inside, "route", "add", "default", "via", f"10.77.{number}.1")

    def impair(self, delay, loss, names=None):
        """Milliseconds and per cent, each way; 100 % is a link that is down."""
        for name in names or self.links:
            self.links[name].impair(delay, loss)

    def programs(self):
        """Those that carry packets, if the kernel does not do it."""
        return [program for link in self.links.values() for program in link.programs]

    def tool(self):
        with open("/proc/sys/net/ipv4/tcp_congestion_control", encoding="ascii") as file:
            tcp = file.read().strip()
        return ("tc netem" if self.kind is NetemLink else "wirefilter") + f", TCP with {tcp}"


def missing_tools():
    """Why there are no such networks here; None when there are."""
    for tool in ("ip", "tc", "mount"):
        if not shutil.which(tool):
            return f"{tool} is not installed"
    if not has_netem() and not (shutil.which("wirefilter") and shutil.which("vde_switch")):
        return "this kernel has no sch_netem, and vde2 is not installed"
    if not os.path.exists("/dev/net/tun"):
        return "there is no /dev/net/tun"
    return None


# Sends or takes datagrams, or the bytes of a connection, in the network of a site.
PEER = """
import socket, sys, time
kind, hub, port, amount = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
if kind == 'datagrams':
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
        for _ in range(int(amount)):
            peer.sendto(bytes(100), (hub, port))
            time.sleep(0.001)
else:
    end = time.monotonic() + amount
    with socket.create_connection((hub, port), 20) as peer:
        peer.settimeout(1)
        while time.monotonic() < end:
            try:
                peer.send(bytes(16384))
            except TimeoutError:
                pass
            except ConnectionError:
                break
        peer.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b'\\1\\0\\0\\0\\0\\0\\0\\0')
"""


def measured_loss(name, count=1000):
    """Per cent of datagrams from a network to the hub that do not arrive."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        own.bind((HUB, 0))
        own.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        subprocess.run(["ip", "netns", "exec", name, sys.executable, "-c", PEER, "datagrams", HUB,
                        str(own.getsockname()[1]), str(count)], check=True)
        own.settimeout(0.5)
        got = 0
        try:
            while own.recv(200):
                got += 1
        except TimeoutError:
            pass
    return 100 * (count - got) / count


def measured_rate(name, seconds=4):
    """Kilobytes in a second that one connection carries from a network to the hub."""
    with socket.socket() as own:
        own.bind((HUB, 0))
        own.listen()
        own.settimeout(20)
        peer = subprocess.Popen(["ip", "netns", "exec", name, sys.executable, "-c", PEER, "bytes", HUB,
                                 str(own.getsockname()[1]), str(seconds)])
        taken, _ = own.accept()
        got = 0
        begin = time.monotonic()
        with taken:
            taken.settimeout(seconds)
            try:
                while time.monotonic() - begin < seconds:
                    got += len(taken.recv(65536))
            except (TimeoutError, ConnectionError):
                pass
        peer.wait()
    return got / 1000 / seconds
