"""The routes and pages of the assessment, for the entry point `rocking.service`."""

from pathlib import Path

from rocking_api.extension import Extension, MenuEntry

from rocking_assessment.service import assess, fragility_model, identify, object_page, objects_page

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
)
