"""Who may do what at an endpoint with TLS: each certificate has the rights of its common name.

Zenoh checks this in the coupler's session, with every message: the keys of a component exist only
for certificates with its name, and for those with the name of the coupler's.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from quintet.interfaces.errors import LineError
from quintet.interfaces.libraries import require

JOIN = "quintet/join"  # everybody may ask here; over TLS the answer is a refusal
ADMIT = "quintet/admit"  # over TLS: ask here with the certificate of the component
EVERYBODY = "@everybody"  # no name of a component
EVERYTHING = (
    "put", "delete", "declare_subscriber", "query", "reply", "declare_queryable",
    "liveliness_token", "liveliness_query", "declare_liveliness_subscriber",
)  # fmt: skip


def access(mine: str, topics: Mapping[str, Iterable[str]]) -> dict[str, Any]:
    """Settings of zenoh's access control.

    Parameters
    ----------
    mine : str
        Common name of the coupler's certificate.
    topics : mapping
        Parts of keys that a component may use, by its name.
    """
    keys = {
        name: [f"{ADMIT}/{name}", *(f"quintet/@{topic}/**" for topic in parts)]
        for name, parts in topics.items()
    }
    of_run = [key for of_name in keys.values() for key in of_name]
    keys[mine] = ["quintet/**", *of_run]
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [_rule(EVERYBODY, [f"{JOIN}/*"]), *(_rule(*entry) for entry in keys.items())],
        "subjects": [
            {"id": EVERYBODY},
            *({"id": name, "cert_common_names": [name]} for name in keys),
        ],
        "policies": [{"rules": [name], "subjects": [name]} for name in (EVERYBODY, *keys)],
    }


def _rule(name: str, keys: list[str]) -> dict[str, Any]:
    return {
        "id": name,
        "messages": list(EVERYTHING),
        "flows": ["ingress", "egress"],
        "permission": "allow",
        "key_exprs": keys,
    }


def common_name(certificate: str) -> str:
    """Common name of the subject of a certificate in a file.

    Parameters
    ----------
    certificate : str
        Path of a file in PEM format, the certificate first.
    """
    require("cryptography", "a run with certificates")
    # Only runs with certificates read them.
    from cryptography import x509

    try:
        subject = x509.load_pem_x509_certificate(Path(certificate).read_bytes()).subject
        names = subject.get_attributes_for_oid(x509.NameOID.COMMON_NAME)
        return str(names[0].value)
    except (OSError, ValueError, IndexError) as error:
        raise LineError(
            f"the certificate {certificate} must be a file in PEM format with a common name "
            f"({error}). Correct scene.tls."
        ) from error
