"""The routes and pages of the assessment, for the entry point `rocking.service`."""

from pathlib import Path

from rocking_api.extension import Extension, MenuEntry
from rocking_api.http.limits import Limit

from rocking_assessment.service import assess, fragility_model, identify, mesh_reader, object_page, objects_page

FOLDER = Path(__file__).parent

EXTENSION = Extension(
    name="assessment",
    routers=(
        assess.router,
        identify.router,
        fragility_model.router,
        objects_page.router,
        object_page.router,
    ),
    menu=(MenuEntry(objects_page.PATH, "Objects"), MenuEntry(object_page.PATH, "One object")),
    templates=FOLDER / "templates",
    static=FOLDER / "static",
    body_limits={
        "/v1/assess": Limit(assess.MAX_BODY, assess.MAX_BODY),
        "/v1/identify": Limit(identify.MAX_BODY, identify.MAX_BODY),
        "/objects/text": Limit(assess.MAX_BODY, assess.MAX_BODY),
        "/objects": Limit(3 * assess.MAX_BODY, 3 * assess.MAX_BODY),  # with signs that are escaped
        "/object": Limit(mesh_reader.MAX_MESH, mesh_reader.MAX_MESH),
    },
)
