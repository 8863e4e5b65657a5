"""HTTP service: responses of rocking blocks from the data sets of the workflow and from the solver."""

from rocking._base.installation import require_extra

require_extra("service", "fastapi", "uvicorn", "pydantic_settings", "jinja2")
