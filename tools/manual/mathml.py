"""Equations as MathML, made as the site is built by the converter of docutils: no script, no font, no request."""
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

logger = logging.getLogger(__name__)


def _mathml(node, inline: bool) -> str:
    try:
        return tex2mathml(node.astext(), inline=inline).replace('xmlns="http://www.w3.org/1998/Math/MathML"', "")
    except SyntaxError as error:
        logger.warning("the equation %r cannot be drawn: %s", node.astext(), error, location=node)
        return "<code>" + node.astext().replace("&", "&amp;").replace("<", "&lt;") + "</code>"


def _inline(writer, node) -> None:
    from docutils.nodes import SkipNode
    writer.body.append(_mathml(node, True))
    raise SkipNode


def _block(writer, node) -> None:
    from docutils.nodes import SkipNode
    writer.body.append('<div class="equation">' + _mathml(node, False) + "</div>")
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
