"""An authority and certificates for the processes of a scene, bound to the names of components."""

import datetime
import ipaddress
import os
import re
import socket
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from quintet.interfaces.errors import SceneError
from quintet.interfaces.libraries import require
from quintet.interfaces.lines.endpoint import ENDPOINT

AUTHORITY, COUPLER = "authority", "coupler"
HOST = re.compile(r"[A-Za-z0-9_]([A-Za-z0-9_.-]*[A-Za-z0-9_])?")
LONGEST_NAME = 64  # characters of a common name: ub-common-name of RFC 5280
CLOCKS = datetime.timedelta(hours=1)  # by which clocks of hosts may differ
LOOPBACK = ("localhost", "127.0.0.1", "::1")


def hosts_of(texts: Sequence[str], names: Iterable[str], endpoint: str) -> dict[str, list[str]]:
    """Hosts for which each certificate is valid, by the name of its component or the coupler.

    Parameters
    ----------
    texts : sequence of str
        ``NAME=HOST,HOST``, as in the option `--hosts`.
    names : iterable of str
        Of the components.
    endpoint : str
        Of the scene, or "".
    """
    hosts: dict[str, list[str]] = {name: [*LOOPBACK] for name in (COUPLER, *names)}
    match = ENDPOINT.fullmatch(endpoint)
    hosts[COUPLER] += [socket.gethostname(), *([match[2].strip("[]")] if match else [])]
    for text in texts:
        name, _, listed = text.partition("=")
        if name not in hosts or not listed:
            raise SceneError(
                f"--hosts must be NAME=HOST,HOST with a component of the scene or {COUPLER}; "
                f"found {text!r}. The scene has {', '.join(hosts)}."
            )
        hosts[name] += listed.split(",")
    for name, listed_hosts in hosts.items():
        for host in listed_hosts:
            if not HOST.fullmatch(host) and not _address(host):
                raise SceneError(
                    f"--hosts {name}: a host must be a name or an IP address; found {host!r}. "
                    "Correct it."
                )
    return {name: list(dict.fromkeys(listed)) for name, listed in hosts.items()}


def write_certificates(folder: Path, hosts: Mapping[str, Sequence[str]], days: int) -> None:
    """Write an authority, and a certificate and key for each name.

    Parameters
    ----------
    folder : path
        Made if it is not there. No file in it is replaced.
    hosts : mapping
        Names and addresses of hosts for which a certificate is valid, by its common name.
    days : int
        For which the certificates are valid.
    """
    require("cryptography", "quintet certificates")
    paths = [folder / f"{name}.{end}" for name in (AUTHORITY, *hosts) for end in ("pem", "key")]
    if AUTHORITY in hosts:
        raise SceneError(
            f"components.{AUTHORITY}: its certificate would be taken for that of the authority. "
            "Name the component otherwise."
        )
    if long := [name for name in hosts if len(name) > LONGEST_NAME]:
        raise SceneError(
            f"components.{long[0]}: the name in a certificate must have at most {LONGEST_NAME} "
            f"characters; found {len(long[0])}. Name the component otherwise."
        )
    if present := [str(path) for path in paths if path.exists() or path.is_symlink()]:
        raise SceneError(
            f"certificates replaces no file; {present[0]} is there. Give another folder with --out."
        )
    authority, written = _Signer(days), list[Path]()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        _write(written, folder, AUTHORITY, *authority.itself())
        for name, listed in hosts.items():
            signed = authority.certificate(name, listed, serves=name == COUPLER)
            _write(written, folder, name, *signed)
    except OSError as error:
        for path in written:  # or a second try would find them, and replace nothing
            path.unlink(missing_ok=True)
        raise SceneError(
            f"--out {folder}: certificates must be written there; they cannot "
            f"({error.strerror or error}). Give another folder."
        ) from error


class _Signer:
    """An authority that signs certificates; its key is made here."""

    def __init__(self, days: int) -> None:
        # Only this command needs it.
        from cryptography.hazmat.primitives.asymmetric import ec

        self.begin = datetime.datetime.now(datetime.UTC) - CLOCKS
        self.end = self.begin + CLOCKS + datetime.timedelta(days=days)
        self._new_key = lambda: ec.generate_private_key(ec.SECP256R1())
        self.key = self._new_key()

    def itself(self) -> tuple[bytes, bytes]:
        """Its own certificate and key, in PEM format."""
        # Only this command needs it.
        from cryptography import x509

        usage = _key_usage(key_cert_sign=True, crl_sign=True)
        limits = x509.BasicConstraints(ca=True, path_length=0)
        return self._signed(AUTHORITY, self.key, [(limits, True), (usage, True)])

    def certificate(self, name: str, hosts: Sequence[str], serves: bool) -> tuple[bytes, bytes]:
        """Certificate and key of a process; only that of the coupler lets it listen."""
        # Only this command needs it.
        from cryptography import x509
        from cryptography.x509.oid import ExtendedKeyUsageOID as Usage

        names = [
            x509.IPAddress(address) if (address := _address(host)) else x509.DNSName(host)
            for host in hosts
        ]
        usages = [Usage.CLIENT_AUTH, *([Usage.SERVER_AUTH] if serves else [])]
        extensions = [
            (x509.SubjectAlternativeName(names), False),
            (x509.ExtendedKeyUsage(usages), False),
            (x509.BasicConstraints(ca=False, path_length=None), True),
            (_key_usage(digital_signature=True), True),
        ]
        return self._signed(name, self._new_key(), extensions)

    def _signed(self, name: str, key: Any, extensions: list[Any]) -> tuple[bytes, bytes]:
        # Only this command needs it.
        from cryptography import x509
        from cryptography.hazmat.primitives import hashes, serialization

        builder = (
            x509.CertificateBuilder()
            .subject_name(_subject(name))
            .issuer_name(_subject(AUTHORITY))
            .public_key(key.public_key())
            .serial_number(x509.random_serial_number())
            .not_valid_before(self.begin)
            .not_valid_after(self.end)
            .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), False)
            .add_extension(
                x509.AuthorityKeyIdentifier.from_issuer_public_key(self.key.public_key()), False
            )
        )
        for extension, critical in extensions:
            builder = builder.add_extension(extension, critical)
        pem = serialization.Encoding.PEM
        form, plain = serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        signed = builder.sign(self.key, hashes.SHA256())
        return signed.public_bytes(pem), key.private_bytes(pem, form, plain)


def _subject(name: str) -> Any:
    # Only this command needs it.
    from cryptography import x509

    return x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)])


def _key_usage(**allowed: bool) -> Any:
    # Only this command needs it.
    from cryptography import x509

    purposes = (
        "digital_signature", "content_commitment", "key_encipherment", "data_encipherment",
        "key_agreement", "key_cert_sign", "crl_sign", "encipher_only", "decipher_only",
    )  # fmt: skip
    return x509.KeyUsage(**{**dict.fromkeys(purposes, False), **allowed})


def _address(host: str) -> Any:
    """IP address of a host that is given by it, else None."""
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None


def _write(written: list[Path], folder: Path, name: str, certificate: bytes, key: bytes) -> None:
    for end, content in (("pem", certificate), ("key", key)):
        path, flags = folder / f"{name}.{end}", os.O_WRONLY | os.O_CREAT | os.O_EXCL
        with open(os.open(path, flags, 0o600), "wb") as file:
            written.append(path)
            file.write(content)


def files_of(folder: Path, name: str) -> list[str]:
    """Authority, certificate and key of a name, as `tls` of a scene and `join --tls` take them."""
    return [str(folder / end) for end in (f"{AUTHORITY}.pem", f"{name}.pem", f"{name}.key")]
