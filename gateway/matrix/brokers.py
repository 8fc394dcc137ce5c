# SPDX-License-Identifier: Apache-2.0
"""Brokers of the fleet matrix, with the settings of examples/fleet: TLS, passwords, and rights that follow from the
export files. They run in the hub's network, at the address of all links.
"""
import json
import os
import re
import shutil
import time
import urllib.request

from network import HUB
from programs import Failure, Program, run, wait_until

EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "examples", "fleet")


def make_certificates(folder):
    """An authority `ca.pem`, and `hub.pem` with `hub.key` for the hub's address."""
    def path(name):
        return os.path.join(folder, name)
    curve = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"]
    run("openssl", "req", "-x509", *curve, "-days", "2", "-subj", "/CN=Matrix", "-keyout", path("ca.key"), "-out", path("ca.pem"))
    run("openssl", "req", *curve, "-subj", "/CN=hub", "-keyout", path("hub.key"), "-out", path("hub.csr"))
    with open(path("names"), "w", encoding="ascii") as file:
        file.write(f"subjectAltName=IP:{HUB}")
    run("openssl", "x509", "-req", "-in", path("hub.csr"), "-CA", path("ca.pem"), "-CAkey", path("ca.key"), "-CAcreateserial",
        "-days", "2", "-extfile", path("names"), "-out", path("hub.pem"))


class Mosquitto:
    """One broker, which keeps nothing when it is killed."""

    programs = ("mosquitto", "mosquitto_passwd")
    scheme = "mqtts"
    replicas = 1

    def __init__(self, folder, users):
        self.folder = folder
        with open(os.path.join(folder, "passwords"), "w", encoding="ascii") as file:
            file.writelines(f"{user}:{password}\n" for user, password in users.items())
        run("mosquitto_passwd", "-U", os.path.join(folder, "passwords"))
        with open(os.path.join(EXAMPLES, "mosquitto.conf"), encoding="utf-8") as file:
            text = file.read()
        text, count = re.subn(r"(?m)^listener 8883 127\.0\.0\.1$", f"listener 8883 {HUB}", text)
        if count != 1:
            raise Failure("mosquitto.conf of examples/fleet has another listener")
        # Files in a folder of root.
        with open(os.path.join(folder, "mosquitto.conf"), "w", encoding="utf-8") as file:
            file.write(text + "user root\n")

    def url(self, _first=0):
        return f"mqtts://{HUB}:8883"

    def start(self, gateway, export_files):
        rights = run(gateway, "--acl", "mosquitto", *export_files)
        with open(os.path.join(self.folder, "robots.acl"), "w", encoding="utf-8") as file:
            file.write(rights + "\nuser probe\ntopic readwrite probe/#\n")
        self.program = Program(self.folder, "mosquitto", ["mosquitto", "-c", "mosquitto.conf"])
        self.program.await_text(" running\n", 20)

    def all(self):
        return [self.program]

    def kill(self, pause):
        """Kills it and starts it again; what it was called."""
        before = self.program.text().count(" running\n")
        self.program.kill()
        time.sleep(pause)
        self.program.start()
        self.program.await_text(" running\n", 20, before + 1)
        return "mosquitto"


class NatsCluster:
    """Three servers with JetStream, of which the leader of the gateways' stream is killed."""

    programs = ("nats-server",)
    scheme = "tls"
    replicas = 3
    count = 3

    def __init__(self, folder, users):
        self.folder = folder
        with open(os.path.join(folder, "passwords.conf"), "w", encoding="ascii") as file:
            file.writelines(f'password_{user}: "{password}"\n' for user, password in users.items())
        routes = ", ".join(f'"nats://127.0.0.1:{6222 + i}"' for i in range(self.count))
        for i in range(self.count):
            with open(os.path.join(folder, f"nats{i}.conf"), "w", encoding="ascii") as file:
                file.write(f'listen: "{HUB}:{4222 + i}"\nhttp: "127.0.0.1:{8222 + i}"\nserver_name: "nats{i}"\n'
                           f'jetstream {{ store_dir: "store{i}" }}\n'
                           f'cluster {{ name: matrix, listen: "127.0.0.1:{6222 + i}", routes: [{routes}] }}\n'
                           f'tls {{ cert_file: "hub.pem", key_file: "hub.key" }}\ninclude robots.conf\n')
        self.servers = {}

    def url(self, first=0):
        """Gateways do not all begin with the same server."""
        return "tls://" + ",".join(f"{HUB}:{4222 + (first + i) % self.count}" for i in range(self.count))

    def start(self, gateway, export_files):
        readers = [word for user in self.reader_users() for word in ("--user", user)]
        rights = run(gateway, "--acl", "nats", *readers, *export_files)
        probe = '    {user: "probe", password: $password_probe}\n'
        end = "  ]\n}\n"
        if not rights.endswith(end):
            raise Failure("the list of rights for NATS has another end")
        with open(os.path.join(self.folder, "robots.conf"), "w", encoding="utf-8") as file:
            file.write(rights[:-len(end)] + probe + end)
        for i in range(self.count):
            name = f"nats{i}"
            self.servers[name] = Program(self.folder, name, ["nats-server", "-c", name + ".conf"])
        wait_until(lambda: all(self.is_healthy(name) for name in self.servers), 30, "servers of NATS")

    def all(self):
        return list(self.servers.values())

    def reader_users(self):
        with open(os.path.join(self.folder, "passwords.conf"), encoding="ascii") as file:
            return re.findall(r"(?m)^password_(desk\w+):", file.read())

    def ask(self, name, path):
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{8222 + int(name[-1])}{path}", timeout=5) as answer:
                return json.load(answer)
        except OSError:
            return {}

    def is_healthy(self, name):
        return self.ask(name, "/healthz").get("status") == "ok"

    def stream(self):
        """Leader and replicas of the stream of the gateways, as a server that is its leader says."""
        for name in self.servers:
            for account in self.ask(name, "/jsz?accounts=true&streams=true").get("account_details", []):
                for stream in account.get("stream_detail", []):
                    cluster = stream.get("cluster", {})
                    if stream["name"] == "RRKEPT" and cluster.get("leader") == name:
                        return name, cluster.get("replicas", [])
        return None, []

    def has_all(self):
        leader, replicas = self.stream()
        is_whole = len(replicas) == self.count - 1 and all(one.get("current") and not one.get("offline") for one in replicas)
        return leader if is_whole and all(self.is_healthy(name) for name in self.servers) else None

    def kill(self, pause):
        # It has to have what the others have before the next one is killed: two of three at any time.
        leader = wait_until(self.has_all, 60, "the three servers have the same")
        self.servers[leader].kill()
        time.sleep(pause)
        self.servers[leader].start()
        return leader


BROKERS = {"mqtt": Mosquitto, "nats": NatsCluster}


def missing_programs(carrier):
    for program in (*BROKERS[carrier].programs, "openssl"):
        if not shutil.which(program):
            return f"{program} is not installed"
    return None
