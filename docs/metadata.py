"""Write codemeta.json and .zenodo.json, which repeat CITATION.cff for archives: `python docs/metadata.py`."""

import json
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[1]


def codemeta(citation: dict[str, Any]) -> dict[str, Any]:
    """Return the description of CodeMeta 3."""
    fields = {"name": "title", "description": "abstract", "keywords": "keywords", "codeRepository": "repository-code"}
    return {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        **{field: citation[key] for field, key in fields.items() if key in citation},
        "license": f"https://spdx.org/licenses/{citation['license']}",
        "author": [{"@type": "Organization", "name": author["name"]} for author in citation["authors"]],
        "programmingLanguage": "Python",
        "referencePublication": [
            {"@type": "ScholarlyArticle", "@id": f"https://doi.org/{paper['doi']}", "name": paper["title"]}
            for paper in citation["references"]
        ],
    }


def zenodo(citation: dict[str, Any]) -> dict[str, Any]:
    """Return the metadata of a Zenodo deposit; Zenodo takes version and date from the release."""
    return {
        "upload_type": "software",
        "title": citation["title"],
        "description": citation["abstract"],
        "creators": [{"name": author["name"]} for author in citation["authors"]],
        "keywords": citation["keywords"],
        "license": citation["license"],
        "access_right": "open",
        "related_identifiers": [
            {"identifier": paper["doi"], "relation": "references", "resource_type": "publication-article"}
            for paper in citation["references"]
        ],
    }


def files() -> dict[str, str]:
    """Return the content of each file by its name."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    contents = {"codemeta.json": codemeta(citation), ".zenodo.json": zenodo(citation)}
    return {name: json.dumps(content, indent=2) + "\n" for name, content in contents.items()}


if __name__ == "__main__":
    for name, content in files().items():
        (ROOT / name).write_text(content, encoding="utf-8")
