"""What a scene becomes is found on another thread, while the prairie goes on as it was."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from tallgrass.systems.prairie import Prairie


def test_a_site_that_another_thread_has_found_comes_with_the_scene_that_it_was_found_for(
    load: Callable[..., Prairie],
) -> None:
    prairie = load()
    assert prairie.path is not None
    text = prairie.path.read_text("utf-8")
    prairie.path.write_text(text.replace("height: [0.3, 0.5]", "height: [0.2, 0.3]"), "utf-8")
    find = prairie.finding()
    prairie.path.write_text("tallgrass: nothing that could be read", "utf-8")
    with ThreadPoolExecutor(1) as hand:
        site = hand.submit(find).result()
    assert prairie.scene.grass["green"].height == [0.3, 0.5]
    prairie.reload(site=site)
    assert prairie.site is site
    assert prairie.scene.grass["green"].height == [0.2, 0.3]
