"""Scenes of Mitsuba 3.

A scene is converted to words: nested dictionaries as `mitsuba.load_dict` reads them, with arrays in
place of Mitsuba's own objects. They become a file here, and objects in the tests that run Mitsuba.

Modules, each importing only what stands above it:

- words: the values of such dictionaries
- textures: images on surfaces
- surfaces: how surfaces scatter, and what they emit
- media: what lies inside and outside of surfaces
- skies: sky and sun
- shapes: shapes
- convert: whole scenes
- sharing: parts that are equal, held once
- xml: words as XML
- file: a scene as a file and its companions
"""
